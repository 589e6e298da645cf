#pragma once

#include <filesystem>

#include "control_client/drive/driven_robot.h"

namespace nadir::control_client {

/// The robot of a ROBOT.yaml, or the one of data/robots/rover.yaml without a file: body rates or
/// rim speeds go out, the firmware turns them into forces. Throws vision::InputError.
DrivenRobot load_rover_robot(const std::filesystem::path& file);

}  // namespace nadir::control_client
