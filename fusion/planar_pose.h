#pragma once

#include <Eigen/Core>
#include <cmath>

namespace nadir::fusion {

/// The angle wrapped to (-pi, pi], rad. The one place where nadir wraps angles.
inline double wrap_angle(double angle_rad) {
  constexpr double kPi = 3.14159265358979323846;
  const double wrapped = std::remainder(angle_rad, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

/// Place and direction of a robot on the field. x and y in metres in the world frame, heading
/// counter-clockwise from the world's x axis, rad, in (-pi, pi].
struct PlanarPose {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;

  Eigen::Vector2d position_m() const { return {x_m, y_m}; }
};

/// Covariance of a planar pose, order x, y, heading; m^2, m rad, rad^2.
using PoseCovariance = Eigen::Matrix3d;

/// Difference a - b in the order x, y, heading, the heading wrapped.
inline Eigen::Vector3d pose_difference(const PlanarPose& a, const PlanarPose& b) {
  return {a.x_m - b.x_m, a.y_m - b.y_m, wrap_angle(a.heading_rad - b.heading_rad)};
}

}  // namespace nadir::fusion
