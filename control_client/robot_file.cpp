#include "control_client/robot_file.h"

#include <numbers>
#include <stdexcept>

#include "vision/input/strict_yaml.h"

namespace nadir::control_client {
namespace {

using vision::ValidRange;
using vision::YamlMap;

// Ranges that nobody's robot leaves: they catch wrong units.
constexpr ValidRange kMass_kg{0.01, 1000.0};
constexpr ValidRange kInertia_kgm2{1e-6, 1000.0};
constexpr ValidRange kLength_m{0.001, 5.0};
constexpr ValidRange kMotorConstant{1e-6, 10.0};
constexpr ValidRange kPositive{1e-12, 1e6};
constexpr ValidRange kDamping{0.05, 0.999};
constexpr ValidRange kBandwidth_radps{0.01, 1000.0};

MotorParameters read_motor(const YamlMap& map) {
  MotorParameters motor;
  motor.torque_constant_nm_per_a =
      map.number_or("torque_constant_nm_per_a", motor.torque_constant_nm_per_a, kMotorConstant);
  motor.back_emf_v_s_per_rad =
      map.number_or("back_emf_v_s_per_rad", motor.back_emf_v_s_per_rad, kMotorConstant);
  motor.resistance_ohm = map.number_or("resistance_ohm", motor.resistance_ohm, {1e-3, 1e4});
  motor.rotor_inertia_kg_m2 =
      map.number_or("rotor_inertia_kg_m2", motor.rotor_inertia_kg_m2, {0.0, 1.0});
  motor.friction_nm_s_per_rad =
      map.number_or("friction_nm_s_per_rad", motor.friction_nm_s_per_rad, {0.0, 1.0});
  motor.gear_ratio = map.number_or("gear_ratio", motor.gear_ratio, {0.01, 1000.0});
  motor.max_voltage_v = map.number_or("max_voltage_v", motor.max_voltage_v, {0.1, 1000.0});
  motor.encoder_counts_per_wheel_turn = map.integer_or(
      "encoder_counts_per_wheel_turn", motor.encoder_counts_per_wheel_turn, {1.0, 1e8});
  map.finish();
  return motor;
}

std::vector<WheelMount> read_wheels(const YamlMap& file) {
  std::vector<WheelMount> wheels;
  for (const YamlMap& map : file.maps("wheels")) {
    const double angle_deg = map.number("angle_deg", {-360.0, 360.0});
    wheels.push_back({angle_deg * std::numbers::pi / 180.0, map.number("distance_m", kLength_m)});
    map.finish();
  }
  return wheels;
}

LoopParameters read_loop(const YamlMap& map, LoopParameters loop) {
  loop.filter_damping = map.number_or("filter_damping", loop.filter_damping, kDamping);
  loop.filter_bandwidth_radps =
      map.number_or("filter_bandwidth_radps", loop.filter_bandwidth_radps, kBandwidth_radps);
  loop.damping = map.number_or("damping", loop.damping, {0.05, 10.0});
  loop.natural_frequency_radps =
      map.number_or("natural_frequency_radps", loop.natural_frequency_radps, kBandwidth_radps);
  map.finish();
  return loop;
}

ControlParameters read_control(const YamlMap& map) {
  ControlParameters control;
  control.tick_s = map.number_or("tick_s", control.tick_s, {0.001, 0.2});
  control.inner_steps = map.integer_or("inner_steps", control.inner_steps, {1.0, 100.0});
  control.tolerated_slip_s =
      map.number_or("tolerated_slip_s", control.tolerated_slip_s, {0.0, 1.0});
  if (const auto outer = map.map_if_present("outer")) {
    control.outer = read_loop(*outer, control.outer);
  }
  if (const auto inner = map.map_if_present("inner")) {
    control.inner = read_loop(*inner, control.inner);
  }
  map.finish();
  return control;
}

}  // namespace

RobotConfig load_robot(const std::filesystem::path& file) {
  const YamlMap map = YamlMap::load(file);
  RobotConfig config;
  RobotParameters& robot = config.robot;
  map.choice_or("type", kOmnidirectional, {kOmnidirectional});
  robot.name = map.text_or("name", file.stem().string());
  robot.mass_kg = map.number_or("mass_kg", robot.mass_kg, kMass_kg);
  robot.inertia_kg_m2 = map.number_or("inertia_kg_m2", robot.inertia_kg_m2, kInertia_kgm2);
  robot.wheel_radius_m = map.number_or("wheel_radius_m", robot.wheel_radius_m, kLength_m);
  robot.wheels = read_wheels(map);
  robot.max_speed_mps = map.number_or("max_speed_mps", robot.max_speed_mps, kPositive);
  robot.max_turn_rate_radps =
      map.number_or("max_turn_rate_radps", robot.max_turn_rate_radps, kPositive);
  if (const auto motor = map.map_if_present("motor")) robot.motor = read_motor(*motor);
  if (const auto control = map.map_if_present("control")) config.control = read_control(*control);
  map.finish();
  try {
    const RobotModel model(robot);
  } catch (const std::invalid_argument& error) {
    throw map.error("wheels", error.what(), "see data/robots/omni3.yaml");
  }
  return config;
}

}  // namespace nadir::control_client
