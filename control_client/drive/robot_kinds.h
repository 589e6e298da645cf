#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "control_client/drive/driven_robot.h"

namespace nadir::control_client {

/// A kind of robot that nadir-client drives.
struct RobotKind {
  std::string name;  ///< `type` of its ROBOT.yaml
  /// Reads ROBOT.yaml; an empty path is the kind's own robot.
  std::function<DrivenRobot(const std::filesystem::path& file)> load;
};
const std::vector<RobotKind>& robot_kinds();

/// The robot of a file. `kind` empty: what the file says, omnidirectional without a file. Throws
/// vision::InputError for an unknown kind, or a file of another kind.
DrivenRobot load_driven_robot(const std::string& kind, const std::filesystem::path& file);

}  // namespace nadir::control_client
