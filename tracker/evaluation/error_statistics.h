#pragma once

#include <Eigen/Core>
#include <vector>

#include "fusion/planar_pose.h"

namespace nadir::tracker {

/// One pose against its truth, reported minus true.
struct PoseError {
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();   ///< x m, y m, heading rad
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< u px, v px of the robot's origin
  fusion::PoseCovariance covariance = fusion::PoseCovariance::Zero();
};

/// Values that a mean is expected to lie between.
struct Band {
  double low = 0.0;
  double high = 0.0;
};

/// What many pose errors have in common. All zero without errors.
struct ErrorStatistics {
  std::size_t count = 0;
  Eigen::Vector3d rms = Eigen::Vector3d::Zero();   ///< x m, y m, heading rad
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();  ///< mean error, x m, y m, heading rad
  Eigen::Vector2d rms_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d bias_px = Eigen::Vector2d::Zero();
  double rms_position_m = 0.0;  ///< of the distance
  double p95_position_m = 0.0;
  double p95_heading_rad = 0.0;
  /// Normalised estimation error squared, e^T P^-1 e, which has mean 3 where the covariances are
  /// honest.
  double mean_nees = 0.0;
  double coverage95 = 0.0;  ///< share of errors within their own 95 % ellipsoid
  std::size_t singular =
      0;  ///< covariances that are not positive definite; left out of the two above
};

ErrorStatistics summarise(const std::vector<PoseError>& errors);

/// Where the mean of `count` independent NEES values of three dimensions lies in 95 % of all
/// experiments (chi-square, 3 count degrees of freedom; Bar-Shalom, Li, Kirubarajan, Estimation
/// with Applications to Tracking and Navigation, section 5.4). Quantiles by Wilson and Hilferty's
/// cube-root approximation, within 1 % from count 3 on. Errors of a robot that stands still repeat
/// and are not independent: the band is then too narrow.
Band nees_band95(std::size_t count);

/// The value that a share (0 to 1) of the values does not exceed (nearest rank); 0 without values.
double percentile(std::vector<double> values, double share);

}  // namespace nadir::tracker
