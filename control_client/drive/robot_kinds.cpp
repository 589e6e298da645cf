#include "control_client/drive/robot_kinds.h"

#include <algorithm>

#include "control_client/differential/differential_robot.h"
#include "control_client/drive/omnidirectional_robot.h"
#include "control_client/rover/rover_file.h"
#include "control_client/rover/rover_robot.h"
#include "vision/input/input_error.h"
#include "vision/input/strict_yaml.h"

namespace nadir::control_client {
namespace {

const RobotKind& kind_of(const std::string& name, const std::filesystem::path& file) {
  const auto& all = robot_kinds();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const RobotKind& k) { return k.name == name; });
  if (found != all.end()) return *found;
  std::string names;
  for (const RobotKind& each : all) names += (names.empty() ? "" : ", ") + each.name;
  throw vision::InputError({file.empty() ? "nadir-client" : file.string(), 0, 0},
                           "no type of robot is called '" + name + "'", "choose one of " + names);
}

}  // namespace

const std::vector<RobotKind>& robot_kinds() {
  static const std::vector<RobotKind> all = {{kOmnidirectional, load_omnidirectional_robot},
                                             {kDifferential, load_differential_robot},
                                             {kRover, load_rover_robot}};
  return all;
}

DrivenRobot load_driven_robot(const std::string& kind, const std::filesystem::path& file) {
  if (file.empty()) return kind_of(kind.empty() ? kOmnidirectional : kind, file).load(file);
  if (!kind.empty()) kind_of(kind, {});
  const std::string own =
      vision::YamlMap::load(file).text_or("type", std::string(kOmnidirectional));
  if (!kind.empty() && kind != own) {
    throw vision::InputError({file.string(), 0, 0},
                             "this robot is of the type " + own + ", not " + kind,
                             "leave --robot-type away or name another robot");
  }
  return kind_of(own, file).load(file);
}

}  // namespace nadir::control_client
