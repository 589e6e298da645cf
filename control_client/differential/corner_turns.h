#pragma once

#include <string>

#include "control_client/trajectory.h"
#include "control_client/trajectory_file.h"

namespace nadir::control_client {

/// A trajectory, called `name` in errors, for a robot that cannot move sideways: where its heading
/// jumps, as in the corners of l-shapes, the robot stands, turns within `limits`, and goes on.
/// Throws vision::InputError if it moves sideways.
TrajectoryPtr with_corner_turns(const std::string& name, TrajectoryPtr trajectory,
                                const MotionLimits& limits);

}  // namespace nadir::control_client
