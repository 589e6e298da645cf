#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "fusion/odometry_step.h"
#include "fusion/planar_pose.h"

namespace nadir::fusion {

/// Variance of odometry that grows with acceleration and is zero while the robot stands (S3 eq 10,
/// theory 5), with a the modulus of the linear acceleration:
///
///     variance of the displacement per second, each direction = k1_m2ps + k2 a^2
///     variance of the heading per second                      = k1_rad2ps + k2 a^2
///
/// K1 and K2 of theory 5 are these times its step of 0.04 s; the defaults are its values for the
/// slip model.
struct AccelerationNoise {
  double k1_m2ps = 1.75e-5;
  double k2_m2ps = 1.84e-6;  ///< a second and (m/s^2)^2
  double k1_rad2ps = 1.57e-3;
  double k2_rad2ps = 2.15e-4;
  /// Slower than both in the present and the previous interval, the robot stands.
  double standing_mps = 1e-3;
  double standing_radps = 1e-2;
};

/// Modulus of the linear acceleration, m/s^2: first difference of the measured mean velocity.
double linear_acceleration_mps2(const OdometryStep& step);

/// The model of odometry's errors with that variance; no states of its own.
class AccelerationOdometryNoise {
 public:
  static constexpr int kStates = 0;

  AccelerationOdometryNoise() = default;
  explicit AccelerationOdometryNoise(const AccelerationNoise& noise) : noise_(noise) {}

  Eigen::Matrix<double, 0, 0> initial_covariance() const { return {}; }
  CorrectedRates<0> corrected(const OdometryStep& step,
                              const Eigen::Matrix<double, 0, 1>& error) const;
  ErrorTransition<0> transition(const OdometryStep& /*step*/) const { return {}; }

 private:
  AccelerationNoise noise_;
};

static_assert(OdometryErrorModel<AccelerationOdometryNoise>);

/// What odometry got wrong in one interval whose ends are known from elsewhere.
struct OdometryErrorSample {
  Eigen::Vector3d error = Eigen::Vector3d::Zero();  ///< x, y (robot frame, m), heading (rad)
  double acceleration_mps2 = 0.0;
  double interval_s = 0.0;
};

/// Odometry's displacement over the whole interval minus the true one from `before` to `after`, in
/// the robot's frame at the start.
OdometryErrorSample odometry_error(const OdometryStep& step, const PlanarPose& before,
                                   const PlanarPose& after);

/// AccelerationNoise found from recorded errors, with the standard errors of its constants as far
/// as the samples are independent.
struct IdentifiedNoise {
  AccelerationNoise noise;
  double sigma_k1_m2ps = 0.0;
  double sigma_k2_m2ps = 0.0;
  double sigma_k1_rad2ps = 0.0;
  double sigma_k2_rad2ps = 0.0;
};

/// Regression of the squared errors per second on a^2 (theory 5), weighted with the variance 2 v^2
/// of a squared normal error of variance v, in a few rounds. No constant is negative: the one that
/// would be is zero and the other fitted alone. Nothing if there are fewer than 10 samples or all
/// have the same acceleration, an interval is not positive or a number is not finite. Leave samples
/// of a standing robot out.
std::optional<IdentifiedNoise> identify_acceleration_noise(
    std::span<const OdometryErrorSample> samples);

}  // namespace nadir::fusion
