#include "fusion/fuse/fuse_config.h"

#include <fmt/format.h>

#include <array>

#include "fusion/timestamp.h"
#include "vision/input/number_text.h"
#include "vision/input/strict_yaml.h"

namespace nadir::fusion {
namespace {

using vision::ValidRange;
using vision::YamlMap;

constexpr ValidRange kAboveZero = {1e-9, 1e9};
constexpr ValidRange kNotNegative = {0.0, 1e9};
constexpr double kPi = 3.14159265358979323846;

/// A gate and its name in the file.
struct GateName {
  const char* name;
  Gate gate;
};
const std::array<GateName, 3> kGates = {{{"chi_square", Gate::chi_square()},
                                         {"rectangular", Gate::rectangular()},
                                         {"none", Gate::none()}}};

void set_number(const YamlMap& map, const std::string& key, ValidRange range, double* value) {
  *value = map.number_or(key, *value, range);
}

void set_seconds(const YamlMap& map, const std::string& key, ValidRange range,
                 std::chrono::nanoseconds* value) {
  if (map.has(key)) *value = from_seconds(map.number(key, range));
}

void read_odometry(const YamlMap& map, FuseConfig* config) {
  set_number(map, "lead_s", {-1.0, 1.0}, &config->odometry_lead_s);
  set_number(map, "walk_u_m_per_sqrt_s", kAboveZero, &config->walk.u_m_per_sqrt_s);
  set_number(map, "walk_v_m_per_sqrt_s", kAboveZero, &config->walk.v_m_per_sqrt_s);
  set_number(map, "walk_r_rad_per_sqrt_s", kAboveZero, &config->walk.r_rad_per_sqrt_s);
  OdometryCheck& check = config->odometry_check;
  set_seconds(map, "join_tolerance_s", {0.0, 1.0}, &check.join_tolerance);
  set_seconds(map, "longest_interval_s", {1e-3, 1e4}, &check.longest_interval);
  set_seconds(map, "longest_gap_s", {1e-3, 1e6}, &check.longest_gap);
  check.restart_after = map.integer_or("restart_after", check.restart_after, {1, 1e6});
  set_number(map, "fastest_mps", kAboveZero, &check.fastest_mps);
  set_number(map, "fastest_radps", kAboveZero, &check.fastest_radps);
  map.finish();
}

void read_vision(const YamlMap& map, FuseConfig* config) {
  set_number(map, "undeclared_delay_s", {-1.0, 1.0}, &config->vision_undeclared_delay_s);
  set_number(map, "future_tolerance_s", {0.0, 10.0}, &config->vision_future_tolerance_s);
  map.finish();
}

void read_gate(const YamlMap& map, Gate* gate) {
  std::vector<std::string> names;
  names.reserve(kGates.size());
  for (const GateName& known : kGates) names.emplace_back(known.name);
  const std::string name = map.choice_or("kind", names.front(), names);
  for (const GateName& known : kGates) {
    if (name == known.name) *gate = known.gate;
  }
  set_number(map, "threshold", kNotNegative, &gate->threshold);
  map.finish();
}

void read_recovery(const YamlMap& map, LockOutRecovery* recovery) {
  recovery->poses = map.integer_or("poses", recovery->poses, {0, 1e6});
  set_number(map, "sigmas", kNotNegative, &recovery->sigmas);
  set_number(map, "margin_m", kNotNegative, &recovery->margin_m);
  set_number(map, "margin_rad", kNotNegative, &recovery->margin_rad);
  set_number(map, "far_m", kNotNegative, &recovery->far_m);
  set_number(map, "far_rad", kNotNegative, &recovery->far_rad);
  map.finish();
}

void read_gap(const YamlMap& map, GapMotion* gap) {
  set_number(map, "hold_s", kNotNegative, &gap->hold_s);
  set_number(map, "acceleration_mps2", kNotNegative, &gap->acceleration_mps2);
  set_number(map, "acceleration_radps2", kNotNegative, &gap->acceleration_radps2);
  set_number(map, "speed_mps", kNotNegative, &gap->speed_mps);
  set_number(map, "speed_radps", kNotNegative, &gap->speed_radps);
  set_number(map, "largest_m", kNotNegative, &gap->largest_m);
  set_number(map, "largest_rad", kNotNegative, &gap->largest_rad);
  map.finish();
}

KnownStart read_start(const YamlMap& map) {
  KnownStart start;
  start.pose.x_m = map.number("x_m", {-1e6, 1e6});
  start.pose.y_m = map.number("y_m", {-1e6, 1e6});
  start.pose.heading_rad = map.number("heading_rad", {-2.0 * kPi, 2.0 * kPi});
  set_number(map, "sigma_m", kAboveZero, &start.sigma_m);
  set_number(map, "sigma_rad", kAboveZero, &start.sigma_rad);
  map.finish();
  return start;
}

/// "  key: value\n"
std::string line(const char* key, double value) {
  return fmt::format("  {}: {}\n", key, vision::text_from_number(value));
}

std::string line(const char* key, std::chrono::nanoseconds span) {
  return line(key, std::chrono::duration<double>(span).count());
}

std::string odometry_yaml(const FuseConfig& config) {
  const OdometryCheck& check = config.odometry_check;
  return "odometry:\n" + line("lead_s", config.odometry_lead_s) +
         line("walk_u_m_per_sqrt_s", config.walk.u_m_per_sqrt_s) +
         line("walk_v_m_per_sqrt_s", config.walk.v_m_per_sqrt_s) +
         line("walk_r_rad_per_sqrt_s", config.walk.r_rad_per_sqrt_s) +
         line("join_tolerance_s", check.join_tolerance) +
         line("longest_interval_s", check.longest_interval) +
         line("longest_gap_s", check.longest_gap) + line("restart_after", check.restart_after) +
         line("fastest_mps", check.fastest_mps) + line("fastest_radps", check.fastest_radps);
}

std::string gate_yaml(const Gate& gate) {
  std::string name;
  for (const GateName& known : kGates) {
    if (known.gate.kind == gate.kind) name = known.name;
  }
  return "gate:\n  kind: " + name + "\n" + line("threshold", gate.threshold);
}

std::string recovery_yaml(const LockOutRecovery& recovery) {
  return "recovery:\n" + line("poses", recovery.poses) + line("sigmas", recovery.sigmas) +
         line("margin_m", recovery.margin_m) + line("margin_rad", recovery.margin_rad) +
         line("far_m", recovery.far_m) + line("far_rad", recovery.far_rad);
}

std::string gap_yaml(const GapMotion& gap) {
  return "gap:\n" + line("hold_s", gap.hold_s) + line("acceleration_mps2", gap.acceleration_mps2) +
         line("acceleration_radps2", gap.acceleration_radps2) + line("speed_mps", gap.speed_mps) +
         line("speed_radps", gap.speed_radps) + line("largest_m", gap.largest_m) +
         line("largest_rad", gap.largest_rad);
}

}  // namespace

WhiteOdometryNoise OdometryWalk::noise() const {
  const Eigen::Vector3d walk(u_m_per_sqrt_s, v_m_per_sqrt_s, r_rad_per_sqrt_s);
  return {walk.cwiseAbs2().asDiagonal(), 1.0};
}

FuseConfig::FuseConfig() {
  // A log says that rates are valid up to the next row, and some are written only on change.
  odometry_check.longest_interval = std::chrono::seconds(2);
}

FuseConfig load_fuse_config(const std::filesystem::path& file) {
  FuseConfig config;
  const YamlMap map = YamlMap::load(file);
  if (const auto part = map.map_if_present("odometry")) read_odometry(*part, &config);
  if (const auto part = map.map_if_present("vision")) read_vision(*part, &config);
  if (const auto part = map.map_if_present("gate")) read_gate(*part, &config.gate);
  if (const auto part = map.map_if_present("recovery")) read_recovery(*part, &config.recovery);
  if (const auto part = map.map_if_present("gap")) read_gap(*part, &config.gap);
  set_number(map, "history_s", {0.01, 1000.0}, &config.history_s);
  if (const auto part = map.map_if_present("start")) config.start = read_start(*part);
  map.finish();
  return config;
}

std::string fuse_config_yaml(const FuseConfig& config) {
  std::string text = odometry_yaml(config) + "vision:\n" +
                     line("undeclared_delay_s", config.vision_undeclared_delay_s) +
                     line("future_tolerance_s", config.vision_future_tolerance_s) +
                     gate_yaml(config.gate) + recovery_yaml(config.recovery) +
                     gap_yaml(config.gap) +
                     fmt::format("history_s: {}\n", vision::text_from_number(config.history_s));
  if (config.start) {
    text += "start:\n" + line("x_m", config.start->pose.x_m) + line("y_m", config.start->pose.y_m) +
            line("heading_rad", config.start->pose.heading_rad) +
            line("sigma_m", config.start->sigma_m) + line("sigma_rad", config.start->sigma_rad);
  }
  return text;
}

}  // namespace nadir::fusion
