#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>

#include "control_client/drive/client_clock.h"
#include "control_client/drive/drive_core.h"
#include "control_client/drive/simulated_base.h"

namespace nadir::control_client {

/// Everything that `nadir-client drive` can be told beside robot and trajectory. Every field has a
/// default that works.
struct DriveConfig {
  int domain = 0;
  std::string partition;
  std::string team = "blue";
  std::filesystem::path robot;  ///< ROBOT.yaml; empty: the type's own, omni3
  std::string robot_type;       ///< empty: what ROBOT.yaml says
  tracker::WheelCommandKind output = tracker::WheelCommandKind::kVolts;
  double command_valid_s = 0.1;
  int realtime_priority = 10;         ///< 1 to 99, taken where the system allows it; 0: none
  double state_interval_s = 0.1;      ///< of the client's state on the network
  double clock_ask_interval_s = 0.2;  ///< of the questions about the tracker's clock
  ClockError clock_error;             ///< on purpose
  double speed = 1.0;                 ///< factor on the trajectory's speed
  bool fits_limits = false;           ///< slow the trajectory down until the robot can drive it
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< of the trajectory's origin: x m, y m, rad
  PlanSettings plan;
  OnboardFusionSettings fusion;
  SafetySettings safety;
  SimulationSettings simulation;
  /// Of the simulated robot: x m, y m, heading rad; nothing: where the trajectory begins.
  std::optional<Eigen::Vector3d> start;
};

/// Reads DRIVE.yaml; what it does not say keeps its default, a path is relative to its folder.
/// Throws vision::InputError with file:line:column.
DriveConfig load_drive_config(const std::filesystem::path& file);

/// The whole configuration as YAML that load_drive_config reads back.
std::string drive_config_yaml(const DriveConfig& config);

}  // namespace nadir::control_client
