#pragma once

#include <Eigen/Core>

#include "fusion/planar_pose.h"

namespace nadir::fusion {

/// Where a landmark is seen from the robot.
struct RangeBearing {
  double range_m = 0.0;      ///< above 0
  double bearing_rad = 0.0;  ///< from the robot's x axis, counter-clockwise

  /// Order range, bearing.
  Eigen::Vector2d vector() const { return {range_m, bearing_rad}; }
};

/// Difference a - b in the order range, bearing, the bearing wrapped.
inline Eigen::Vector2d sighting_difference(const RangeBearing& a, const RangeBearing& b) {
  return {a.range_m - b.range_m, wrap_angle(a.bearing_rad - b.bearing_rad)};
}

/// Covariance of independent errors of range and bearing: m^2, rad^2.
inline Eigen::Matrix2d sighting_covariance(double sigma_range_m, double sigma_bearing_rad) {
  return Eigen::Vector2d(sigma_range_m * sigma_range_m, sigma_bearing_rad * sigma_bearing_rad)
      .asDiagonal();
}

/// What is expected to be seen, with derivatives (rows range, bearing).
struct PredictedSighting {
  RangeBearing seen;
  Eigen::Matrix<double, 2, 3> by_pose = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix2d by_landmark = Eigen::Matrix2d::Zero();
};

/// A landmark's range and bearing from a pose, both in one frame (S4, theory 6). With
/// (dx, dy) = landmark - position and q = dx^2 + dy^2 > 0, r = sqrt q:
///
///     range = r,                bearing = wrap(atan2(dy, dx) - heading)
///     d range   = [-dx/r, -dy/r,  0 |  dx/r, dy/r]
///     d bearing = [ dy/q, -dx/q, -1 | -dy/q, dx/q]
///
/// Nearer than a millimetre the derivatives are those at a millimetre.
PredictedSighting predicted_sighting(const PlanarPose& pose, const Eigen::Vector2d& landmark_m);

/// A landmark at the place where it was seen, with derivatives.
struct PlacedLandmark {
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
  Eigen::Matrix<double, 2, 3> by_pose = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix2d by_sighting = Eigen::Matrix2d::Zero();
};

/// The inverse: landmark = position + range (cos a, sin a), a = heading + bearing.
PlacedLandmark placed_landmark(const PlanarPose& pose, const RangeBearing& seen);

}  // namespace nadir::fusion
