#include "control_client/differential/differential_robot.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "control_client/differential/corner_turns.h"
#include "control_client/differential/differential_base.h"
#include "control_client/differential/unicycle_steering.h"

namespace nadir::control_client {
namespace {

// Limits as the choice of a trajectory wants them. There are no motors behind these numbers: the
// firmware has its own.
RobotConfig description(const DifferentialParameters& parameters) {
  RobotConfig config;
  config.robot.name = parameters.name;
  config.robot.max_speed_mps = parameters.limits.speed_mps;
  config.robot.max_turn_rate_radps = parameters.limits.turn_rate_radps;
  constexpr double kMoreThanEnough_v = 1000.0;
  config.robot.motor.max_voltage_v = kMoreThanEnough_v;
  config.control.tick_s = parameters.tick_s;
  config.control.inner_steps = 1;
  return config;
}

MotionLimits corner_limits(const UnicycleLimits& limits) {
  constexpr double kReserve = 0.8;  // the rest is the controller's
  MotionLimits corners;
  corners.turn_rate_radps = std::min(corners.turn_rate_radps, kReserve * limits.turn_rate_radps);
  return corners;
}

}  // namespace

DrivenRobot load_differential_robot(const std::filesystem::path& file) {
  const DifferentialParameters parameters =
      file.empty() ? DifferentialParameters{} : load_differential_parameters(file);
  DrivenRobot robot;
  robot.config = description(parameters);
  robot.geometry = fusion::WheelGeometry::differential(parameters.track_m);
  robot.takes_volts = false;
  robot.moves_sideways = false;
  robot.steering = std::make_shared<UnicycleSteering>(parameters.weights, parameters.limits);
  robot.suited = [limits = corner_limits(parameters.limits)](const std::string& name,
                                                             TrajectoryPtr trajectory) {
    return with_corner_turns(name, std::move(trajectory), limits);
  };
  robot.simulated = [parameters](const SimulationSettings& settings, fusion::Timestamp now,
                                 SimulatedBase::TruthSink on_truth) {
    return std::make_unique<DifferentialBase>(parameters, settings, now, std::move(on_truth));
  };
  return robot;
}

}  // namespace nadir::control_client
