#pragma once

#include <filesystem>
#include <string>

#include "control_client/rover/rover_firmware.h"
#include "control_client/rover/rover_model.h"
#include "control_client/rover/rover_plant.h"

namespace nadir::control_client {

/// Value of the key `type` of a rover's ROBOT.yaml.
inline constexpr const char* kRover = "rover";

/// A rover that is driven, as data/robots/rover.yaml says it.
struct RoverRobot {
  std::string name = "rover";
  RoverParameters body;
  DriveLosses losses;              ///< of the simulated one
  RoverFirmwareSettings firmware;  ///< step_s is the simulation's
  double max_speed_mps = 0.5;      ///< of a commanded u or v; C_S of S4's guidance
  double max_turn_rate_radps = 2.0;
  double tick_s = 0.02;
};

/// Reads ROBOT.yaml strictly; every key but `type` has the default above. Throws
/// vision::InputError: unknown or duplicate key, value out of range, another type.
RoverRobot load_rover_robot_file(const std::filesystem::path& file);

}  // namespace nadir::control_client
