#pragma once

#include <filesystem>

#include "control_client/control_parameters.h"
#include "control_client/robot_model.h"

namespace nadir::control_client {

/// Values of the key `type` of a ROBOT.yaml.
inline constexpr const char* kOmnidirectional = "omnidirectional";
inline constexpr const char* kDifferential = "differential";

/// A robot and how it is controlled, as data/robots/*.yaml says it.
struct RobotConfig {
  RobotParameters robot;
  ControlParameters control;
};

/// Reads an omnidirectional robot strictly; every key but `wheels` has the default of omni3. Throws
/// InputError: unknown, duplicate or missing key, value out of range, fewer than 3 or more than 6
/// wheels, wheels that cannot drive the body in all directions.
RobotConfig load_robot(const std::filesystem::path& file);

}  // namespace nadir::control_client
