#pragma once

#include <Eigen/Core>
#include <stdexcept>

#include "fusion/odometry_error_decay.h"
#include "fusion/odometry_step.h"

namespace nadir::fusion {

/// What is known beforehand of body rates of any origin, in the order u, v, r. The defaults are
/// wide enough for velocities that were only commanded, to a robot that follows them later and
/// not quite.
struct BodyRateErrorParameters {
  /// Standard deviations of the scale of each rate (constant).
  Eigen::Vector3d scale_sigma{0.1, 0.1, 0.1};
  /// Standard deviations of the time by which each rate is early (positive) or late, s; this is
  /// also the slip time of a wheel that drives along this axis.
  Eigen::Vector3d lead_sigma_s{0.2, 0.2, 0.2};
  double lead_correlation_s = 1.0;
  /// Standard deviations of what is wrong for some time without a known cause, m/s, m/s, rad/s.
  Eigen::Vector3d drift_sigma{0.02, 0.005, 0.06};
  double drift_correlation_s = 0.5;
  /// White noise of the rates over 0.02 s, m/s, m/s, rad/s.
  Eigen::Vector3d noise{0.01, 0.005, 0.02};
};

/// Errors of body rates whose origin is not known well, with three states of the filter for each
/// rate q: a scale e (constant), a lead l and a drift b (first-order Gauss-Markov, mean zero):
///
///     measured q = true q (1 + e) + l dq/dt + b + white noise
///
/// Order of the states: the scales of u, v, r, their leads, their drifts. Rates and their
/// derivatives are the measured ones.
class BodyRateError {
 public:
  static constexpr int kStates = 9;
  using ErrorState = Eigen::Matrix<double, kStates, 1>;
  using ErrorCovariance = Eigen::Matrix<double, kStates, kStates>;

  BodyRateError() : BodyRateError(BodyRateErrorParameters{}) {}

  /// Throws std::invalid_argument for a negative standard deviation or a correlation time that is
  /// not positive.
  explicit BodyRateError(const BodyRateErrorParameters& parameters) : parameters_(parameters) {
    const bool is_valid =
        parameters.scale_sigma.minCoeff() >= 0.0 && parameters.lead_sigma_s.minCoeff() >= 0.0 &&
        parameters.drift_sigma.minCoeff() >= 0.0 && parameters.noise.minCoeff() >= 0.0 &&
        parameters.lead_correlation_s > 0.0 && parameters.drift_correlation_s > 0.0;
    if (!is_valid) {
      throw std::invalid_argument("negative standard deviation or no correlation time");
    }
    constexpr double kNoiseInterval_s = 0.02;
    white_intensity_ = (parameters.noise.cwiseAbs2() * kNoiseInterval_s).asDiagonal();
  }

  const BodyRateErrorParameters& parameters() const { return parameters_; }

  ErrorCovariance initial_covariance() const {
    ErrorState sigma;
    sigma << parameters_.scale_sigma, parameters_.lead_sigma_s, parameters_.drift_sigma;
    return sigma.cwiseAbs2().asDiagonal();
  }

  CorrectedRates<kStates> corrected(const OdometryStep& step, const ErrorState& error) const {
    const Eigen::Vector3d rate = step.mean_rates.vector();
    // Over this interval and not between the middles of both: a command jumps where its interval
    // begins, and the robot follows all of the change from there on.
    const Eigen::Vector3d derivative = (rate - step.previous_rates.vector()) / step.interval_s;
    CorrectedRates<kStates> result;
    result.rates = BodyRates::from(rate - error.head<3>().cwiseProduct(rate) -
                                   error.segment<3>(3).cwiseProduct(derivative) - error.tail<3>());
    result.by_error.leftCols<3>().diagonal() = -rate;
    result.by_error.middleCols<3>(3).diagonal() = -derivative;
    result.by_error.rightCols<3>().diagonal().setConstant(-1.0);
    result.white_intensity = white_intensity_;
    return result;
  }

  ErrorTransition<kStates> transition(const OdometryStep& step) const {
    const double keep_lead = decay(step.dt_s, parameters_.lead_correlation_s);
    const double keep_drift = decay(step.dt_s, parameters_.drift_correlation_s);
    ErrorTransition<kStates> result;
    result.transition.diagonal().segment<3>(3).setConstant(keep_lead);
    result.transition.diagonal().tail<3>().setConstant(keep_drift);
    result.noise_covariance.diagonal().segment<3>(3) =
        (1.0 - keep_lead * keep_lead) * parameters_.lead_sigma_s.cwiseAbs2();
    result.noise_covariance.diagonal().tail<3>() =
        (1.0 - keep_drift * keep_drift) * parameters_.drift_sigma.cwiseAbs2();
    return result;
  }

 private:
  BodyRateErrorParameters parameters_;
  Eigen::Matrix3d white_intensity_;
};

static_assert(OdometryErrorModel<BodyRateError>);

}  // namespace nadir::fusion
