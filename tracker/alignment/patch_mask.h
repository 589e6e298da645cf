#pragma once

#include <Eigen/Core>
#include <array>

#include "tracker/alignment/disc_patch.h"

namespace nadir::tracker {

inline constexpr int kMostObstacles = 12;

/// A circle on the plane whose inside says nothing of a disc: another robot.
struct Obstacle {
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
  double radius_m = 0.0;
};

/// Where a robot's plate ends, in its own frame.
struct PlateShape {
  double radius_m = 0.0;  ///< of the circle about the robot's origin
  double front_m = 0.0;   ///< cut flat here
};

/// Sets use = 0 for pixels beyond the plate of the robot at `origin_m`, whose front is at
/// `forward` (a unit vector), and for those in obstacles.
void mask(const PlateShape& plate, const Eigen::Vector2d& origin_m, const Eigen::Vector2d& forward,
          const Obstacle* obstacles, int obstacle_count, DiscPatch& patch);

/// Sets use = 0 for pixels that are nearer to the edge of another disc than to that of this one.
void leave_to(const Eigen::Vector2d& own_centre_m, double own_radius_m,
              const Eigen::Vector2d& other_centre_m, double other_radius_m, DiscPatch& patch);

}  // namespace nadir::tracker
