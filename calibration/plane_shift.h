#pragma once

#include <Eigen/Core>

namespace nadir::calibration {

/// The parallax of a plane that is not the calibrated one: seen from a camera above `nadir_m` at
/// height H, what stands on the calibrated plane (height h0) at p stands on the plane of height h
/// at
///
///     p' = nadir + scale (p - nadir),   scale = (H - h) / (H - h0)
///
/// (theory 4.4). Both are known with an error only, or not at all: then the scale is 1 and its
/// variance says what that may cost.
struct PlaneShift {
  Eigen::Vector2d nadir_m = Eigen::Vector2d::Zero();  ///< of the camera, on the field
  double scale = 1.0;                                 ///< above 0
  Eigen::Matrix2d nadir_covariance_m2 = Eigen::Matrix2d::Zero();
  double scale_variance = 0.0;

  Eigen::Vector2d shifted(const Eigen::Vector2d& place_m) const {
    return nadir_m + scale * (place_m - nadir_m);
  }
  Eigen::Vector2d unshifted(const Eigen::Vector2d& place_m) const {
    return nadir_m + (place_m - nadir_m) / scale;
  }
  /// What the errors of the nadir and of the scale, taken as independent, add at `place_m` of the
  /// calibrated plane: (1 - scale)^2 N + scale_variance (r r^T + N), r = place - nadir.
  Eigen::Matrix2d covariance_m2(const Eigen::Vector2d& place_m) const {
    const Eigen::Vector2d arm_m = place_m - nadir_m;
    const double move = 1.0 - scale;
    return (move * move + scale_variance) * nadir_covariance_m2 +
           scale_variance * (arm_m * arm_m.transpose());
  }
};

}  // namespace nadir::calibration
