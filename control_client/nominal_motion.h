#pragma once

#include <Eigen/Core>
#include <cmath>

namespace nadir::control_client {

/// Rotation from body to world of (x, y, heading) vectors: R(psi) of S0 eq 1.
inline Eigen::Matrix3d rotation_world_body(double heading_rad) {
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  return (Eigen::Matrix3d() << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0).finished();
}

/// What the robot is meant to do at one instant, in the world frame: order x, y, heading; m, rad.
/// The heading is unwrapped: it never jumps.
struct NominalMotion {
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_per_s = Eigen::Vector3d::Zero();

  /// q_n = R(psi_n)^T p_n' (S2 eq 6): u m/s, v m/s, r rad/s.
  Eigen::Vector3d body_rates() const {
    return rotation_world_body(pose.z()).transpose() * velocity_per_s;
  }
};

}  // namespace nadir::control_client
