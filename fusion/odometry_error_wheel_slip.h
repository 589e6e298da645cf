#pragma once

#include <Eigen/Core>
#include <stdexcept>

#include "fusion/odometry_error_decay.h"
#include "fusion/odometry_step.h"
#include "fusion/wheel_geometry.h"

namespace nadir::fusion {

/// What is known beforehand of a robot with wheel encoders. The defaults are meant for rubber-tyred
/// wheels of a few centimetres; the filter learns the rest on the way.
struct WheelSlipParameters {
  /// Standard deviation of each wheel's scale: by which share its radius differs from what it is
  /// believed to be.
  double scale_sigma = 0.02;
  /// Standard deviation of each wheel's slip time: 0.025 s lose 5 mm of rim travel when the speed
  /// changes by 0.2 m/s.
  double slip_time_sigma_s = 0.025;
  /// The ground changes: time after which a slip time is another one, s.
  double slip_correlation_s = 1.0;
  /// White noise of a rim speed measured over 0.02 s: quantisation and roughness of the ground.
  double rim_noise_mps = 0.006;
  /// What of a slip time cannot be learnt, as it changes within a tenth of a second or because the
  /// wheel's measured acceleration is not the true one, s. A slip that is not learnt acts for a
  /// tenth of a second, so it is white noise of intensity (sigma a)^2 * 0.1 s where the rim's
  /// acceleration is a: in a hard start or stop the poses are believed more than the wheels.
  double unlearnt_slip_sigma_s = 0.0;
};

/// Odometry errors with their causes. For every wheel i a scale e_i, constant, and a slip time l_i
/// (first-order Gauss-Markov with mean zero), as a tyre that pushes the robot turns farther than it
/// travels, in proportion to the force:
///
///     measured rim speed = true (1 + e_i) + l_i acceleration_i + white noise
///
/// e_i and l_i are states of the filter (all scales, then all slip times), so a slip that lasts for
/// several frames is an error that these frames explain, and not independent noise in each of
/// them. Speeds and accelerations are the measured ones; of the squared acceleration that makes
/// white noise, what rim_noise_mps alone is expected to make of it is taken away.
template <int kWheels>
class WheelSlipError {
  static_assert(kWheels >= 2 && kWheels <= kMaxWheels);

 public:
  static constexpr int kStates = 2 * kWheels;
  using ErrorState = Eigen::Matrix<double, kStates, 1>;
  using ErrorCovariance = Eigen::Matrix<double, kStates, kStates>;

  /// S2's robot (theory 1.1).
  WheelSlipError() requires(kWheels == 3) : WheelSlipError(WheelGeometry::three_wheel(0.070), {}) {}

  /// Throws std::invalid_argument where the geometry has another number of wheels or a parameter
  /// is not positive (the standard deviations may be zero).
  WheelSlipError(const WheelGeometry& geometry, const WheelSlipParameters& parameters)
      : parameters_(parameters) {
    if (geometry.wheels() != kWheels) throw std::invalid_argument("other number of wheels");
    if (!(parameters.scale_sigma >= 0.0 && parameters.slip_time_sigma_s >= 0.0 &&
          parameters.rim_noise_mps >= 0.0 && parameters.unlearnt_slip_sigma_s >= 0.0 &&
          parameters.slip_correlation_s > 0.0)) {
      throw std::invalid_argument("negative standard deviation or no correlation time");
    }
    rims_by_rates_ = geometry.rims_by_rates();
    for (int i = 0; i < kWheels; ++i) {
      rates_by_rims_.col(i) = geometry.body_rates(WheelValues::Unit(kWheels, i)).vector();
    }
    constexpr double kNoiseInterval_s = 0.02;
    rim_intensity_m2ps_ = square(parameters.rim_noise_mps) * kNoiseInterval_s;
    unlearnt_intensity_s3_ = square(parameters.unlearnt_slip_sigma_s) * kUnlearntFor_s;
  }

  const WheelSlipParameters& parameters() const { return parameters_; }

  ErrorCovariance initial_covariance() const {
    ErrorState variances;
    variances << Wheels::Constant(square(parameters_.scale_sigma)),
        Wheels::Constant(square(parameters_.slip_time_sigma_s));
    return variances.asDiagonal();
  }

  CorrectedRates<kStates> corrected(const OdometryStep& step, const ErrorState& error) const {
    const Wheels speed = rims_by_rates_ * step.mean_rates.vector();
    const Wheels acceleration =
        (speed - rims_by_rates_ * step.previous_rates.vector()) / step.between_middles_s();
    const Wheels corrected_speed = speed - error.template head<kWheels>().cwiseProduct(speed) -
                                   error.template tail<kWheels>().cwiseProduct(acceleration);
    CorrectedRates<kStates> result;
    result.rates = BodyRates::from(rates_by_rims_ * corrected_speed);
    result.by_error.template leftCols<kWheels>() = -rates_by_rims_ * speed.asDiagonal();
    result.by_error.template rightCols<kWheels>() = -rates_by_rims_ * acceleration.asDiagonal();
    // The mean rate over T has the variance rim_intensity / T. The square of a real acceleration
    // keeps its mean; of the encoders' own, less than half is left.
    const double encoders_m2ps4 = rim_intensity_m2ps_ *
                                  (1.0 / step.previous_interval_s + 1.0 / step.interval_s) /
                                  square(step.between_middles_s());
    const Wheels intensity =
        (unlearnt_intensity_s3_ * (acceleration.array().square() - encoders_m2ps4).max(0.0) +
         rim_intensity_m2ps_)
            .matrix();
    result.white_intensity = rates_by_rims_ * intensity.asDiagonal() * rates_by_rims_.transpose();
    return result;
  }

  ErrorTransition<kStates> transition(const OdometryStep& step) const {
    const double keep = decay(step.dt_s, parameters_.slip_correlation_s);
    const double noise = (1.0 - square(keep)) * square(parameters_.slip_time_sigma_s);
    ErrorTransition<kStates> result;
    result.transition.diagonal().template tail<kWheels>().setConstant(keep);
    result.noise_covariance.diagonal().template tail<kWheels>().setConstant(noise);
    return result;
  }

 private:
  using Wheels = Eigen::Matrix<double, kWheels, 1>;
  static constexpr double kUnlearntFor_s = 0.1;  ///< a slip that is not learnt acts so long
  static constexpr double square(double x) { return x * x; }

  WheelSlipParameters parameters_;
  Eigen::Matrix<double, kWheels, 3> rims_by_rates_;
  Eigen::Matrix<double, 3, kWheels> rates_by_rims_;
  double rim_intensity_m2ps_ = 0.0;     ///< of a rim speed's white noise, (m/s)^2 s
  double unlearnt_intensity_s3_ = 0.0;  ///< the same for an acceleration of 1 m/s^2
};

static_assert(OdometryErrorModel<WheelSlipError<3>>);

}  // namespace nadir::fusion
