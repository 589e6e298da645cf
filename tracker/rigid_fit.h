#pragma once

#include <Eigen/Core>
#include <span>

#include "fusion/planar_pose.h"

namespace nadir::tracker {

/// One marker of a robot: where it was seen and where it is mounted.
struct PlaneMarker {
  Eigen::Vector2d position_world_m = Eigen::Vector2d::Zero();  ///< seen, on the marker plane
  Eigen::Vector2d position_robot_m =
      Eigen::Vector2d::Zero();  ///< mounted, x to the front, y to the left
  Eigen::Matrix2d covariance_m2 =
      Eigen::Matrix2d::Zero();  ///< of the seen position, positive definite
};

/// The pose that explains the markers best, and how well it does.
struct RigidFit {
  fusion::PlanarPose pose_world_robot;
  /// (A^T W A)^-1: what the markers' covariances say, whatever the residuals are.
  fusion::PoseCovariance covariance = fusion::PoseCovariance::Zero();
  double chi_square = 0.0;     ///< residuals against the markers' covariances
  int degrees_of_freedom = 0;  ///< 2 n - 3
};

/// Weighted least squares of a rotation and a translation (no scale, no reflection) for n >= 2
/// markers whose mounting places differ: the maximum-likelihood pose for independent Gaussian
/// errors. All markers count, so the robot's origin is known better than its centre marker alone.
/// Starts from the closed form of Procrustes' problem (Umeyama, PAMI 1991, without scale);
/// allocates nothing.
RigidFit fit_rigid_pose(std::span<const PlaneMarker> markers);

}  // namespace nadir::tracker
