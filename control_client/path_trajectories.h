#pragma once

#include <vector>

#include "control_client/trajectory.h"

namespace nadir::control_client {

// Trajectories whose heading is the direction of motion: for robots that cannot move sideways.

/// From corner to corner (m, two or more, no two alike in a row) at a constant speed; velocity and
/// heading jump in the corners, where the speed is that of the side that begins.
TrajectoryPtr corner_trajectory(const std::vector<Eigen::Vector2d>& corners_m, double speed_mps);

/// Two full circles that touch in the start, a figure of eight: from `start` (x m, y m, heading
/// rad) to the left, then to the right, at a constant speed.
TrajectoryPtr two_circles_trajectory(const Eigen::Vector3d& start, double radius_m,
                                     double speed_mps);

/// S1's two L shapes, 6 m at 0.1 m/s.
TrajectoryPtr l_shapes_trajectory();
/// S1's two circles of 0.5 m radius at 0.1 m/s.
TrajectoryPtr s1_circles_trajectory();
/// Square of 1 m side around the origin from its lower left corner, one lap at 0.1 m/s.
TrajectoryPtr square_along_trajectory();

}  // namespace nadir::control_client
