#pragma once

#include <Eigen/Core>
#include <cmath>

namespace nadir::fusion {

/// Velocity of the robot in its own frame: x to the front, y to the left, turning
/// counter-clockwise.
struct BodyRates {
  double u_mps = 0.0;
  double v_mps = 0.0;
  double r_radps = 0.0;

  /// Order u, v, r.
  Eigen::Vector3d vector() const { return {u_mps, v_mps, r_radps}; }
  static BodyRates from(const Eigen::Vector3d& rates) { return {rates.x(), rates.y(), rates.z()}; }

  bool is_finite() const {
    return std::isfinite(u_mps) && std::isfinite(v_mps) && std::isfinite(r_radps);
  }
};

}  // namespace nadir::fusion
