#pragma once

#include <string>

#include "control_client/drive/drive_config.h"
#include "control_client/drive/driven_robot.h"

namespace nadir::control_client {

/// What is in force, as a DRIVE.yaml that reads back the same in any folder: the robot's file has
/// an absolute path. The controller's gains are keys of the robot's file; those in force are
/// comments.
std::string printed_config(DriveConfig config, const DrivenRobot& robot);

}  // namespace nadir::control_client
