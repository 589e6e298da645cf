#include "control_client/drive/drive_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

#include "tracker/wire/wire_options.h"
#include "vision/input/number_text.h"
#include "vision/input/strict_yaml.h"

namespace nadir::control_client {
namespace {

using vision::ValidRange;
using vision::YamlMap;

constexpr ValidRange kTime_s{1e-3, 1e4};
constexpr ValidRange kSigma{1e-6, 1e3};
constexpr ValidRange kPlace_m{-1e4, 1e4};
constexpr ValidRange kTurn_deg{-360.0, 360.0};
constexpr double kDegree_rad = std::numbers::pi / 180.0;

/// Takes values out of a file.
class Reader {
 public:
  explicit Reader(const YamlMap& map) : map_(map) {}

  bool has(const char* key, bool /*is_set*/) const { return map_.has(key); }
  void number(const char* key, ValidRange range, double* value) {
    *value = map_.number_or(key, *value, range);
  }
  void integer(const char* key, ValidRange range, int* value) {
    *value = map_.integer_or(key, *value, range);
  }
  void boolean(const char* key, bool* value) { *value = map_.boolean_or(key, *value); }
  void text(const char* key, std::string* value) { *value = map_.text_or(key, *value); }
  template <class Enum>
  void choice(const char* key, const std::vector<std::string>& names, Enum* value) {
    const auto present = static_cast<std::size_t>(*value);
    const std::string name = map_.choice_or(key, names[present], names);
    *value = static_cast<Enum>(std::ranges::find(names, name) - names.begin());
  }
  template <class Part>
  void section(const char* key, Part part) {
    if (const auto map = map_.map_if_present(key)) {
      Reader reader(*map);
      part(reader);
      map->finish();
    }
  }

 private:
  const YamlMap& map_;
};

/// Puts the same values into a text.
class Writer {
 public:
  explicit Writer(std::string* text, std::string indent = "")
      : text_(text), indent_(std::move(indent)) {}

  bool has(const char* /*key*/, bool is_set) const { return is_set; }
  void number(const char* key, ValidRange /*range*/, const double* value) {
    line(key, vision::text_from_number(*value));
  }
  void integer(const char* key, ValidRange /*range*/, const int* value) {
    line(key, fmt::format("{}", *value));
  }
  void boolean(const char* key, const bool* value) { line(key, *value ? "true" : "false"); }
  void text(const char* key, const std::string* value) {
    std::string quoted;
    for (const char c : *value) quoted += c == '\'' ? std::string("''") : std::string(1, c);
    line(key, "'" + quoted + "'");
  }
  template <class Enum>
  void choice(const char* key, const std::vector<std::string>& names, const Enum* value) {
    line(key, names.at(static_cast<std::size_t>(*value)));
  }
  template <class Part>
  void section(const char* key, Part part) {
    *text_ += fmt::format("{}{}:\n", indent_, key);
    Writer writer(text_, indent_ + "  ");
    part(writer);
  }

 private:
  void line(const char* key, const std::string& value) {
    *text_ += fmt::format("{}{}: {}\n", indent_, key, value);
  }

  std::string* text_;
  std::string indent_;
};

// In the order of their enums.
const std::vector<std::string> kOutputs = {"body_rates", "rim_speeds", "volts"};
const std::vector<std::string> kNominals = {"filtered", "exact", "shaped"};
const std::vector<std::string> kModels = {"wheel_slip", "white"};
const std::vector<std::string> kEncoders = {"slip", "white", "perfect"};

template <class Io>
void pose(Io& io, const char* key, Eigen::Vector3d* place) {
  io.section(key, [&](auto& part) {
    double heading_deg = place->z() / kDegree_rad;
    part.number("x_m", kPlace_m, &place->x());
    part.number("y_m", kPlace_m, &place->y());
    part.number("heading_deg", kTurn_deg, &heading_deg);
    place->z() = heading_deg * kDegree_rad;
  });
}

template <class Io>
void limit(Io& io, const char* key, SafetyLimit* limit) {
  io.section(key, [&](auto& part) {
    part.number("slow", kSigma, &limit->slow);
    part.number("stop", kSigma, &limit->stop);
  });
}

template <class Io>
void trajectory(Io& io, DriveConfig* config) {
  io.number("speed", {0.01, 100.0}, &config->speed);
  io.boolean("fit", &config->fits_limits);
  io.boolean("repeat", &config->plan.repeats);
  pose(io, "place", &config->place);
  io.choice("nominal", kNominals, &config->plan.nominal.kind);
  io.number("preview_s", {0.0, 10.0}, &config->plan.nominal.preview_s);
  io.number("ramp_s", kTime_s, &config->plan.ramp_s);
  io.section("approach", [&](auto& part) {
    MotionLimits& limits = config->plan.approach;
    part.number("speed_mps", {1e-3, 100.0}, &limits.speed_mps);
    part.number("acceleration_mps2", {1e-3, 100.0}, &limits.acceleration_mps2);
    part.number("turn_rate_radps", {1e-3, 100.0}, &limits.turn_rate_radps);
    part.number("turn_acceleration_radps2", {1e-3, 100.0}, &limits.turn_acceleration_radps2);
  });
}

template <class Io>
void fusion_part(Io& io, OnboardFusionSettings* fusion) {
  io.choice("model", kModels, &fusion->model);
  io.number("scale_sigma", {0.0, 1.0}, &fusion->wheel_slip.scale_sigma);
  io.number("slip_time_sigma_s", {0.0, 10.0}, &fusion->wheel_slip.slip_time_sigma_s);
  io.number("slip_correlation_s", kTime_s, &fusion->wheel_slip.slip_correlation_s);
  io.number("rim_noise_mps", {0.0, 10.0}, &fusion->wheel_slip.rim_noise_mps);
  io.number("unlearnt_slip_sigma_s", {0.0, 10.0}, &fusion->wheel_slip.unlearnt_slip_sigma_s);
  io.number("white_rim_sigma_mps", kSigma, &fusion->white_rim_sigma_mps);
  io.number("gate", {0.1, 1e6}, &fusion->gate.threshold);
  io.integer("recover_after_poses", {0.0, 1e6}, &fusion->recovery.poses);
}

template <class Io>
void safety_part(Io& io, SafetySettings* safety) {
  limit(io, "pose_age_s", &safety->pose_age_s);
  limit(io, "position_sigma_m", &safety->position_sigma_m);
  limit(io, "heading_sigma_rad", &safety->heading_sigma_rad);
  limit(io, "off_track_m", &safety->off_track_m);
  limit(io, "off_track_rad", &safety->off_track_rad);
  limit(io, "saturated_share", &safety->saturated_share);
  io.number("odometry_silent_s", kTime_s, &safety->odometry_silent_s);
  io.number("command_gap_s", kTime_s, &safety->command_gap_s);
  io.number("release", {0.0, 1.0}, &safety->release);
  io.number("resume_after_s", {0.0, 1e4}, &safety->resume_after_s);
  io.number("slow_pace", {0.0, 1.0}, &safety->slow_pace);
}

template <class Io>
void simulation_part(Io& io, DriveConfig* config) {
  EncoderParameters& encoders = config->simulation.encoders;
  int seed = static_cast<int>(config->simulation.seed);
  io.integer("seed", {0.0, 2e9}, &seed);
  config->simulation.seed = static_cast<std::uint64_t>(seed);
  if (io.has("start", config->start.has_value())) {
    if (!config->start) config->start.emplace(Eigen::Vector3d::Zero());
    pose(io, "start", &*config->start);
  }
  io.choice("encoders", kEncoders, &encoders.kind);
  io.number("scale_deviation", {0.0, 1.0}, &encoders.scale_deviation);
  io.number("slip_mean_s", {-1.0, 1.0}, &encoders.slip_mean_s);
  io.number("slip_deviation_s", {0.0, 1.0}, &encoders.slip_deviation_s);
  io.number("white_mps", {0.0, 10.0}, &encoders.white_mps);
}

template <class Io>
void everything(Io& io, DriveConfig* config) {
  std::string robot = config->robot.string();
  io.integer("domain", {0.0, static_cast<double>(tracker::kMaxDomain)}, &config->domain);
  io.text("partition", &config->partition);
  io.text("team", &config->team);
  io.text("robot", &robot);
  config->robot = robot;
  io.text("robot_type", &config->robot_type);
  io.choice("output", kOutputs, &config->output);
  io.number("command_valid_s", {0.005, 10.0}, &config->command_valid_s);
  io.integer("realtime_priority", {0.0, 99.0}, &config->realtime_priority);
  io.number("state_interval_s", {0.01, 10.0}, &config->state_interval_s);
  io.section("clock", [&](auto& part) {
    part.number("ask_interval_s", {0.01, 10.0}, &config->clock_ask_interval_s);
    part.number("error_s", {-1e6, 1e6}, &config->clock_error.offset_s);
    part.number("drift_ppm", {-1e4, 1e4}, &config->clock_error.drift_ppm);
  });
  io.section("trajectory", [&](auto& part) { trajectory(part, config); });
  io.section("fusion", [&](auto& part) { fusion_part(part, &config->fusion); });
  io.section("safety", [&](auto& part) { safety_part(part, &config->safety); });
  io.section("simulation", [&](auto& part) { simulation_part(part, config); });
}

}  // namespace

DriveConfig load_drive_config(const std::filesystem::path& file) {
  const YamlMap map = YamlMap::load(file);
  DriveConfig config;
  Reader reader(map);
  everything(reader, &config);
  map.finish();
  if (!config.robot.empty() && config.robot.is_relative()) {
    config.robot = (file.parent_path() / config.robot).lexically_normal();
  }
  if (config.team.empty() || config.team.size() > tracker::kMaxTeamLength) {
    throw map.error("team", "a team's name has 1 to 15 bytes", "see the layout of the robots");
  }
  return config;
}

std::string drive_config_yaml(const DriveConfig& config) {
  std::string text;
  Writer writer(&text);
  DriveConfig copy = config;
  everything(writer, &copy);
  return text;
}

}  // namespace nadir::control_client
