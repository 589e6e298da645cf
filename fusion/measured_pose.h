#pragma once

#include <optional>

#include "fusion/planar_pose.h"
#include "fusion/verdict.h"

namespace nadir::fusion {

/// Farthest from the world's origin that a pose can be meant, m.
inline constexpr double kFarthestPose_m = 1e6;

/// Why a pose with this covariance cannot be used at all, or nothing: not finite or farther than
/// kFarthestPose_m; covariance not symmetric (beyond a millionth of its variances' geometric mean)
/// or not positive definite.
std::optional<PoseVerdict> reason_to_refuse(const PlanarPose& pose,
                                            const PoseCovariance& covariance);

/// The mean of a matrix and its transpose.
inline PoseCovariance symmetric_part(const PoseCovariance& covariance) {
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace nadir::fusion
