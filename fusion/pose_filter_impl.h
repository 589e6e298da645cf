#pragma once

// The functions of PoseFilter; included by its header alone.

#include <Eigen/LU>
#include <cmath>

#include "fusion/pose_filter.h"

namespace nadir::fusion {

template <class Linearization, OdometryErrorModel OdometryError>
auto PoseFilter<Linearization, OdometryError>::predict(const OdometryStep& step,
                                                       const Nominal& nominal) -> Covariance {
  // x- = x + motion(rates(e)),  e- = Fe e
  //     F = [ A  W J ]     A = by_pose, W = by_rates along the line of linearization,
  //         [ 0  Fe  ]     J = d rates / d e
  // P- = F P F^T + [ W (intensity / dt) W^T  0 ; 0  Qe ]
  Covariance f = Covariance::Identity();
  if (!state_.has_started) return f;
  const CorrectedRates<kErrorStates> corrected =
      settings_.odometry_error.corrected(step, state_.odometry_error);
  const Motion estimated =
      constant_rate_motion(state_.pose.heading_rad, corrected.rates, step.dt_s);
  const auto& line = Linearization::motion(estimated, nominal, step.dt_s);

  f.template topLeftCorner<3, 3>() = line.by_pose();
  const Eigen::Matrix3d& w = line.by_rates;
  if constexpr (kErrorStates > 0) {
    const ErrorTransition<kErrorStates> error = settings_.odometry_error.transition(step);
    f.template topRightCorner<3, kErrorStates>() = w * corrected.by_error;
    f.template bottomRightCorner<kErrorStates, kErrorStates>() = error.transition;
    state_.covariance = (f * state_.covariance * f.transpose()).eval();
    state_.covariance.template bottomRightCorner<kErrorStates, kErrorStates>() +=
        error.noise_covariance;
    state_.odometry_error = (error.transition * state_.odometry_error).eval();
  } else {
    state_.covariance = (f * state_.covariance * f.transpose()).eval();
  }
  state_.covariance.template topLeftCorner<3, 3>() +=
      w * (corrected.white_intensity / step.dt_s) * w.transpose();

  state_.pose = moved(state_.pose, estimated);
  if (state_.rejected.poses > 0) {
    state_.rejected.pose = moved(state_.rejected.pose, corrected.rates, step.dt_s);
  }
  return f;
}

template <class Linearization, OdometryErrorModel OdometryError>
auto PoseFilter<Linearization, OdometryError>::predict_gap(const BodyRates& last_rates, double dt_s)
    -> Covariance {
  if (!state_.has_started) return Covariance::Identity();
  const BodyRates rates = settings_.gap.rates(last_rates, dt_s);
  Covariance f = predict({rates, rates, dt_s, dt_s}, Nominal{});
  const double sigma_m = settings_.gap.sigma_m(dt_s);
  const double sigma_rad = settings_.gap.sigma_rad(dt_s);
  state_.covariance(0, 0) += sigma_m * sigma_m;
  state_.covariance(1, 1) += sigma_m * sigma_m;
  state_.covariance(2, 2) += sigma_rad * sigma_rad;
  state_.rejected = RejectedRun{};
  return f;
}

template <class Linearization, OdometryErrorModel OdometryError>
Correction PoseFilter<Linearization, OdometryError>::correct(const PlanarPose& measured,
                                                             const PoseCovariance& covariance) {
  Correction correction;
  if (const auto reason = reason_to_refuse(measured, covariance)) {
    correction.verdict = *reason;
    return correction;
  }
  const PoseCovariance r = symmetric_part(covariance);
  if (!state_.has_started) {
    start(measured, r);
    correction.verdict = PoseVerdict::kStarted;
    return correction;
  }
  correction.compare(measured, r, state_.pose, state_.pose_covariance());
  if (settings_.gate.passes(correction.innovation, correction.innovation_covariance,
                            correction.nis)) {
    apply(correction.innovation, r);
    state_.rejected = RejectedRun{};
    correction.verdict = PoseVerdict::kAccepted;
  } else {
    correction.verdict = judge_rejected(measured, r, correction.innovation);
  }
  return correction;
}

template <class Linearization, OdometryErrorModel OdometryError>
PoseVerdict PoseFilter<Linearization, OdometryError>::judge_rejected(
    const PlanarPose& measured, const PoseCovariance& covariance,
    const Eigen::Vector3d& innovation) {
  const LockOutRecovery& recovery = settings_.recovery;
  extend(state_.rejected, recovery, measured, covariance.diagonal());
  if (recovery.poses <= 0 || state_.rejected.poses < recovery.poses) return PoseVerdict::kGated;
  if (innovation.head<2>().norm() > recovery.far_m || std::abs(innovation.z()) > recovery.far_rad) {
    start(measured, covariance);
    return PoseVerdict::kReset;
  }
  // Where the truth is that far off, the variance is at least the square of that.
  state_.covariance.template topLeftCorner<3, 3>().diagonal() += innovation.cwiseAbs2();
  apply(innovation, covariance);
  state_.rejected = RejectedRun{};
  return PoseVerdict::kRecovered;
}

template <class Linearization, OdometryErrorModel OdometryError>
void PoseFilter<Linearization, OdometryError>::apply(const Eigen::Vector3d& innovation,
                                                     const PoseCovariance& covariance) {
  // K = P H^T (H P H^T + R)^-1 with H = [I 0];  x+ = x- + K e
  // P = (I - K H) P (I - K H)^T + K R K^T    (Joseph: stays symmetric and positive)
  using Gain = Eigen::Matrix<double, kStates, 3>;
  const Eigen::Matrix3d s = state_.pose_covariance() + covariance;
  const Gain k = state_.covariance.template leftCols<3>() * s.inverse();
  const Eigen::Matrix<double, kStates, 1> change = k * innovation;
  state_.pose = {state_.pose.x_m + change[0], state_.pose.y_m + change[1],
                 wrap_angle(state_.pose.heading_rad + change[2])};
  if constexpr (kErrorStates > 0) state_.odometry_error += change.template tail<kErrorStates>();
  Covariance left = Covariance::Identity();
  left.template leftCols<3>() -= k;
  const Covariance joseph =
      left * state_.covariance * left.transpose() + k * covariance * k.transpose();
  state_.covariance = 0.5 * (joseph + joseph.transpose());
}

template <class Linearization, OdometryErrorModel OdometryError>
void PoseFilter<Linearization, OdometryError>::set_pose(const PlanarPose& pose,
                                                        const PoseCovariance& covariance) {
  state_.has_started = true;
  state_.pose = {pose.x_m, pose.y_m, wrap_angle(pose.heading_rad)};
  state_.covariance.template topLeftCorner<3, 3>() = covariance;
  if constexpr (kErrorStates > 0) {
    state_.covariance.template bottomRightCorner<kErrorStates, kErrorStates>() =
        settings_.odometry_error.initial_covariance();
  }
}

}  // namespace nadir::fusion
