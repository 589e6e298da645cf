#pragma once

#include <filesystem>

#include "control_client/drive/driven_robot.h"

namespace nadir::control_client {

/// The robot of a ROBOT.yaml, or the one of data/robots/differential.yaml without a file: body
/// rates or rim speeds (left, right) go out, trajectories must not move sideways. Throws
/// vision::InputError.
DrivenRobot load_differential_robot(const std::filesystem::path& file);

}  // namespace nadir::control_client
