#include "control_client/rover/rover_file.h"

#include "vision/input/strict_yaml.h"

namespace nadir::control_client {

RoverRobot load_rover_robot_file(const std::filesystem::path& file) {
  const auto map = vision::YamlMap::load(file);
  RoverRobot robot;
  map.choice_or("type", kRover, {kRover});
  robot.name = map.text_or("name", file.stem().string());
  robot.body.mass_kg = map.number_or("mass_kg", robot.body.mass_kg, {0.01, 1000.0});
  robot.body.inertia_kgm2 = map.number_or("inertia_kg_m2", robot.body.inertia_kgm2, {1e-6, 1000.0});
  robot.body.arm_m = map.number_or("arm_m", robot.body.arm_m, {0.001, 5.0});
  robot.losses.input_loss = map.number_or("input_loss", robot.losses.input_loss, {0.0, 0.9});
  robot.losses.friction_n = map.number_or("friction_n", robot.losses.friction_n, {0.0, 1000.0});
  // With steps of 5 ms.
  constexpr vision::ValidRange kBandwidth_radps{0.1, 100.0};
  robot.firmware.observer_radps =
      map.number_or("observer_radps", robot.firmware.observer_radps, kBandwidth_radps);
  robot.firmware.velocity_radps =
      map.number_or("velocity_radps", robot.firmware.velocity_radps, kBandwidth_radps);
  robot.max_speed_mps = map.number_or("max_speed_mps", robot.max_speed_mps, {0.01, 10.0});
  robot.max_turn_rate_radps =
      map.number_or("max_turn_rate_radps", robot.max_turn_rate_radps, {0.01, 50.0});
  robot.tick_s = map.number_or("tick_s", robot.tick_s, {0.001, 0.2});
  map.finish();
  return robot;
}

}  // namespace nadir::control_client
