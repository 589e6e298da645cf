#pragma once

#include <Eigen/Core>
#include <concepts>

#include "fusion/body_rates.h"

namespace nadir::fusion {

/// What odometry says about a piece of time: an interval that was measured as a whole, or the part
/// of it before or after a pose that was captured inside.
struct OdometryStep {
  BodyRates mean_rates;      ///< over the whole interval
  BodyRates previous_rates;  ///< of the interval before; mean_rates where there was none
  double interval_s = 0.0;   ///< length of the whole interval, above 0
  double dt_s = 0.0;         ///< length of this part, above 0, at most interval_s
  /// Length of the interval before, above 0; as long as this one unless stated.
  double previous_interval_s = interval_s;

  /// Between the middles of both intervals: a constant acceleration times this is the difference of
  /// their mean rates.
  double between_middles_s() const { return 0.5 * (previous_interval_s + interval_s); }
};

/// Measured rates as a model of the odometry's errors sees them. N: number of its error states.
template <int N>
struct CorrectedRates {
  BodyRates rates;  ///< best guess of the true mean rates
  /// Derivative of the corrected rates by the error states.
  Eigen::Matrix<double, 3, N> by_error = Eigen::Matrix<double, 3, N>::Zero();
  /// White part of the error: covariance of the mean rates over a time t is intensity / t, so the
  /// covariance of the motion adds when an interval is split (theory 3.2). (m/s)^2 s and alike.
  Eigen::Matrix3d white_intensity = Eigen::Matrix3d::Zero();
};

/// How the error states change in a time: e+ = transition e + noise.
template <int N>
struct ErrorTransition {
  Eigen::Matrix<double, N, N> transition = Eigen::Matrix<double, N, N>::Identity();
  Eigen::Matrix<double, N, N> noise_covariance = Eigen::Matrix<double, N, N>::Zero();
};

/// A model of odometry's errors is a value with kStates (0 or more) states of its own, which the
/// filter estimates beside the pose. All of it is evaluated at the start of the step.
template <class Model>
concept OdometryErrorModel = requires(const Model& model, const OdometryStep& step,
                                      const Eigen::Matrix<double, Model::kStates, 1>& error) {
  {
    model.initial_covariance()
    } -> std::convertible_to<Eigen::Matrix<double, Model::kStates, Model::kStates>>;
  { model.corrected(step, error) } -> std::same_as<CorrectedRates<Model::kStates>>;
  { model.transition(step) } -> std::same_as<ErrorTransition<Model::kStates>>;
};

}  // namespace nadir::fusion
