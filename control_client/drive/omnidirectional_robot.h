#pragma once

#include <filesystem>

#include "control_client/drive/driven_robot.h"

namespace nadir::control_client {

/// The robot of a ROBOT.yaml; omni3 without a file. Throws vision::InputError.
DrivenRobot load_omnidirectional_robot(const std::filesystem::path& file);

}  // namespace nadir::control_client
