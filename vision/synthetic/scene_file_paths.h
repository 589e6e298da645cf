#pragma once

#include "vision/input/strict_yaml.h"
#include "vision/synthetic/robot_path.h"

namespace nadir::vision {

/// Reads a robot's `path` mapping. Its `kind` (static, line, circle, square, waypoints) decides the
/// other keys.
RobotPath read_robot_path(const YamlMap& map);

}  // namespace nadir::vision
