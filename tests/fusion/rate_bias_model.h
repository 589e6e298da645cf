#pragma once

#include <cmath>

#include "fusion/odometry_step.h"

namespace nadir::fusion::test {

/// A model with states, for tests of the filter: a bias of each rate that wanders (first-order
/// Gauss-Markov), and white noise.
struct RateBiasModel {
  static constexpr int kStates = 3;
  Eigen::Vector3d bias_variance{4e-4, 4e-4, 4e-2};
  double time_constant_s = 0.5;
  Eigen::Matrix3d white = Eigen::Vector3d(1e-6, 1e-6, 1e-4).asDiagonal();

  Eigen::Matrix3d initial_covariance() const { return bias_variance.asDiagonal(); }
  CorrectedRates<3> corrected(const OdometryStep& step, const Eigen::Vector3d& bias) const {
    return {BodyRates::from(step.mean_rates.vector() - bias), -Eigen::Matrix3d::Identity(), white};
  }
  ErrorTransition<3> transition(const OdometryStep& step) const {
    const double keep = std::exp(-step.dt_s / time_constant_s);
    return {keep * Eigen::Matrix3d::Identity(),
            (1.0 - keep * keep) * Eigen::Matrix3d(bias_variance.asDiagonal())};
  }
};

static_assert(OdometryErrorModel<RateBiasModel>);

}  // namespace nadir::fusion::test
