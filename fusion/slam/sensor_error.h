#pragma once

#include <Eigen/Core>
#include <concepts>

#include "fusion/odometry_error_decay.h"
#include "fusion/odometry_step.h"
#include "fusion/slam/range_bearing.h"

namespace nadir::fusion {

/// A sighting without the sensor's systematic errors, as far as they are known.
template <int N>
struct CorrectedSighting {
  RangeBearing seen;
  Eigen::Matrix2d by_measured = Eigen::Matrix2d::Identity();
  /// Derivative of the corrected sighting by the error states.
  Eigen::Matrix<double, 2, N> by_error = Eigen::Matrix<double, 2, N>::Zero();
};

/// A model of a landmark sensor's systematic errors is a value with kStates (0 or more) states of
/// its own, which the filter estimates beside the pose, as it does with odometry's. They start at
/// zero.
template <class Model>
concept SensorErrorModel = requires(const Model& model, const RangeBearing& measured, double dt_s,
                                    const Eigen::Matrix<double, Model::kStates, 1>& error) {
  {
    model.initial_covariance()
    } -> std::convertible_to<Eigen::Matrix<double, Model::kStates, Model::kStates>>;
  { model.corrected(measured, error) } -> std::same_as<CorrectedSighting<Model::kStates>>;
  { model.transition(dt_s) } -> std::same_as<ErrorTransition<Model::kStates>>;
};

/// A sensor whose errors are white. No states of its own.
class NoSensorError {
 public:
  static constexpr int kStates = 0;
  Eigen::Matrix<double, 0, 0> initial_covariance() const { return {}; }
  CorrectedSighting<0> corrected(const RangeBearing& measured,
                                 const Eigen::Matrix<double, 0, 1>& /*error*/) const {
    return {measured, Eigen::Matrix2d::Identity(), {}};
  }
  ErrorTransition<0> transition(double /*dt_s*/) const { return {}; }
};

/// What is known beforehand of a camera that reads ranges from the size of marks.
struct CameraSensorParameters {
  double range_scale_sigma = 0.03;     ///< constant
  double range_offset_sigma_m = 0.03;  ///< constant
  /// A bearing error that all landmarks have in common and that wanders: the camera's mount, the
  /// robot's wobble, a jitter of its clock while it turns.
  double bearing_sigma_rad = 0.012;
  double bearing_correlation_s = 3.0;
};

/// Systematic errors of such a camera, three states: scale s and offset o of the range (constant),
/// and a bearing error b that all landmarks share (first-order Gauss-Markov):
///
///     measured range = true range (1 + s) + o + white,   measured bearing = true + b + white
class CameraSensorError {
 public:
  static constexpr int kStates = 3;
  using ErrorState = Eigen::Vector3d;

  CameraSensorError() = default;
  explicit CameraSensorError(const CameraSensorParameters& parameters) : parameters_(parameters) {}

  const CameraSensorParameters& parameters() const { return parameters_; }

  Eigen::Matrix3d initial_covariance() const {
    return Eigen::Vector3d(parameters_.range_scale_sigma, parameters_.range_offset_sigma_m,
                           parameters_.bearing_sigma_rad)
        .cwiseAbs2()
        .asDiagonal();
  }

  CorrectedSighting<kStates> corrected(const RangeBearing& measured,
                                       const ErrorState& error) const {
    const double factor = 1.0 / (1.0 + error[0]);
    CorrectedSighting<kStates> result;
    result.seen = {(measured.range_m - error[1]) * factor,
                   wrap_angle(measured.bearing_rad - error[2])};
    result.by_measured(0, 0) = factor;
    result.by_error(0, 0) = -result.seen.range_m * factor;
    result.by_error(0, 1) = -factor;
    result.by_error(1, 2) = -1.0;
    return result;
  }

  ErrorTransition<kStates> transition(double dt_s) const {
    const double keep = decay(dt_s, parameters_.bearing_correlation_s);
    ErrorTransition<kStates> result;
    result.transition(2, 2) = keep;
    result.noise_covariance(2, 2) =
        (1.0 - keep * keep) * parameters_.bearing_sigma_rad * parameters_.bearing_sigma_rad;
    return result;
  }

 private:
  CameraSensorParameters parameters_;
};

static_assert(SensorErrorModel<NoSensorError>);
static_assert(SensorErrorModel<CameraSensorError>);

}  // namespace nadir::fusion
