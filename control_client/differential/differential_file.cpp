#include "control_client/differential/differential_file.h"

#include "control_client/robot_file.h"
#include "vision/input/strict_yaml.h"

namespace nadir::control_client {
namespace {

constexpr vision::ValidRange kWeight{1e-3, 1e6};

}  // namespace

DifferentialParameters load_differential_parameters(const std::filesystem::path& file) {
  const auto map = vision::YamlMap::load(file);
  DifferentialParameters robot;
  map.choice_or("type", kDifferential, {kDifferential});
  robot.name = map.text_or("name", file.stem().string());
  robot.track_m = map.number_or("track_m", robot.track_m, {0.01, 5.0});
  robot.limits.speed_mps = map.number_or("max_speed_mps", robot.limits.speed_mps, {0.01, 10.0});
  robot.limits.turn_rate_radps =
      map.number_or("max_turn_rate_radps", robot.limits.turn_rate_radps, {0.01, 50.0});
  robot.wheel_lag_s = map.number_or("wheel_lag_s", robot.wheel_lag_s, {0.001, 2.0});
  robot.tick_s = map.number_or("tick_s", robot.tick_s, {0.001, 0.2});
  if (const auto weights = map.map_if_present("weights")) {
    robot.weights.ahead = weights->number_or("ahead", robot.weights.ahead, kWeight);
    robot.weights.side = weights->number_or("side", robot.weights.side, kWeight);
    robot.weights.heading = weights->number_or("heading", robot.weights.heading, kWeight);
    weights->finish();
  }
  map.finish();
  return robot;
}

}  // namespace nadir::control_client
