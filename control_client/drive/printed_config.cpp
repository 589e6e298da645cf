#include "control_client/drive/printed_config.h"

#include <fmt/format.h>

#include <filesystem>

#include "vision/input/number_text.h"

namespace nadir::control_client {
namespace {

std::string comment(const char* key, double value) {
  return fmt::format("#   {}: {}\n", key, vision::text_from_number(value));
}

std::string comment(const char* key, const LoopParameters& loop) {
  using vision::text_from_number;
  return fmt::format(
      "#   {}: {{filter_damping: {}, filter_bandwidth_radps: {}, damping: {}, "
      "natural_frequency_radps: {}}}\n",
      key, text_from_number(loop.filter_damping), text_from_number(loop.filter_bandwidth_radps),
      text_from_number(loop.damping), text_from_number(loop.natural_frequency_radps));
}

}  // namespace

std::string printed_config(DriveConfig config, const DrivenRobot& robot) {
  if (!config.robot.empty()) {
    config.robot = std::filesystem::absolute(config.robot).lexically_normal();
  }
  const ControlParameters& control = robot.config.control;
  const bool has_inner = config.output == tracker::WheelCommandKind::kVolts;
  std::string text = drive_config_yaml(config);
  text += "# The controller in force. Its keys belong in the robot's file (control).\n";
  text += comment("tick_s", control.tick_s);
  if (robot.steering == nullptr) text += comment("outer", control.outer);
  if (has_inner) {
    text += fmt::format("#   inner_steps: {}\n", control.inner_steps);
    text += comment("tolerated_slip_s", control.tolerated_slip_s);
    text += "#   No stiffer than the tolerated slip allows:\n";
    text += comment("inner", control.inner);
  }
  return text;
}

}  // namespace nadir::control_client
