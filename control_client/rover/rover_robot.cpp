#include "control_client/rover/rover_robot.h"

#include <memory>
#include <utility>

#include "control_client/rover/rover_base.h"
#include "control_client/rover/rover_file.h"

namespace nadir::control_client {
namespace {

RobotConfig description(const RoverRobot& rover) {
  RobotConfig config;
  config.robot = rover_description(rover.body);
  config.robot.name = rover.name;
  config.robot.max_speed_mps = rover.max_speed_mps;
  config.robot.max_turn_rate_radps = rover.max_turn_rate_radps;
  config.control.tick_s = rover.tick_s;
  config.control.inner_steps = 1;
  return config;
}

}  // namespace

DrivenRobot load_rover_robot(const std::filesystem::path& file) {
  const RoverRobot rover = file.empty() ? RoverRobot{} : load_rover_robot_file(file);
  DrivenRobot robot;
  robot.config = description(rover);
  robot.takes_volts = false;
  robot.simulated = [rover](const SimulationSettings& settings, fusion::Timestamp now,
                            SimulatedBase::TruthSink on_truth) {
    return std::make_unique<RoverBase>(rover, settings, now, std::move(on_truth));
  };
  return robot;
}

}  // namespace nadir::control_client
