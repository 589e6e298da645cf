#pragma once

#include <Eigen/Core>

#include "fusion/odometry_step.h"

namespace nadir::fusion {

/// Odometry whose mean rates have independent errors of constant covariance Q in every interval of
/// some length T: white noise of intensity Q T. No states of its own.
class WhiteOdometryNoise {
 public:
  static constexpr int kStates = 0;

  /// `rate_covariance` Q: of the mean rates (u, v, r) over one interval of `interval_s` > 0; from
  /// rim noise by WheelGeometry::rate_covariance. The default is S2's robot with rims of 0.03 m/s
  /// at 50 Hz (theory 3).
  WhiteOdometryNoise()
      : WhiteOdometryNoise(Eigen::Vector3d(6e-4, 6e-4, 0.0612).asDiagonal(), 0.02) {}
  WhiteOdometryNoise(const Eigen::Matrix3d& rate_covariance, double interval_s)
      : intensity_(rate_covariance * interval_s) {}

  Eigen::Matrix<double, 0, 0> initial_covariance() const { return {}; }

  CorrectedRates<0> corrected(const OdometryStep& step,
                              const Eigen::Matrix<double, 0, 1>& /*error*/) const {
    return {step.mean_rates, {}, intensity_};
  }

  ErrorTransition<0> transition(const OdometryStep& /*step*/) const { return {}; }

 private:
  Eigen::Matrix3d intensity_;
};

static_assert(OdometryErrorModel<WhiteOdometryNoise>);

}  // namespace nadir::fusion
