#pragma once

#include <Eigen/LU>

#include "fusion/planar_pose.h"
#include "fusion/verdict.h"

namespace nadir::fusion {

/// What a measured pose did, and what it was compared with.
struct Correction {
  PoseVerdict verdict = PoseVerdict::kNotFinite;
  /// Measured minus predicted, order x, y, heading, the heading wrapped; zero for kStarted and
  /// poses that were refused.
  Eigen::Vector3d innovation = Eigen::Vector3d::Zero();
  /// Of the innovation: predicted covariance plus the measured pose's, before any inflation.
  Eigen::Matrix3d innovation_covariance = Eigen::Matrix3d::Zero();
  double nis = 0.0;  ///< normalised innovation squared, expectation 3

  /// Fills all but the verdict. Covariances in m and rad, symmetric positive definite.
  void compare(const PlanarPose& measured, const PoseCovariance& covariance,
               const PlanarPose& predicted, const PoseCovariance& predicted_covariance) {
    innovation = pose_difference(measured, predicted);
    innovation_covariance = predicted_covariance + covariance;
    nis = innovation.dot(innovation_covariance.inverse() * innovation);
  }
};

}  // namespace nadir::fusion
