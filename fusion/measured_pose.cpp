#include "fusion/measured_pose.h"

#include <Eigen/LU>
#include <cmath>

namespace nadir::fusion {
namespace {

bool is_symmetric(const PoseCovariance& covariance) {
  constexpr double kTolerance = 1e-6;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < i; ++j) {
      const double scale = std::sqrt(std::abs(covariance(i, i) * covariance(j, j)));
      if (!(std::abs(covariance(i, j) - covariance(j, i)) <= kTolerance * scale)) return false;
    }
  }
  return true;
}

// Sylvester: all leading minors are positive, here of the correlations, so that units do not count.
bool is_positive_definite(const PoseCovariance& covariance) {
  constexpr double kSmallest = 1e-12;
  const Eigen::Vector3d variance = covariance.diagonal();
  if (!(variance.minCoeff() > 0.0)) return false;
  const Eigen::Vector3d scale = variance.cwiseSqrt().cwiseInverse();
  const Eigen::Matrix3d correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  return scale.allFinite() && 1.0 - correlation(0, 1) * correlation(0, 1) > kSmallest &&
         correlation.determinant() > kSmallest;
}

}  // namespace

std::optional<PoseVerdict> reason_to_refuse(const PlanarPose& pose,
                                            const PoseCovariance& covariance) {
  const bool is_near =
      std::abs(pose.x_m) <= kFarthestPose_m && std::abs(pose.y_m) <= kFarthestPose_m;
  if (!is_near || !std::isfinite(pose.heading_rad) || !covariance.allFinite()) {
    return PoseVerdict::kNotFinite;
  }
  if (!is_symmetric(covariance)) return PoseVerdict::kCovarianceNotSymmetric;
  if (!is_positive_definite(symmetric_part(covariance))) {
    return PoseVerdict::kCovarianceNotPositive;
  }
  return std::nullopt;
}

}  // namespace nadir::fusion
