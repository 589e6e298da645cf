#pragma once

// The functions of EkfSlam; included by its header alone.

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cassert>
#include <cmath>

#include "fusion/odometry.h"
#include "fusion/sine_cosine.h"
#include "fusion/slam/ekf_slam.h"

namespace nadir::fusion {

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
EkfSlam<OdometryError, SensorError>::EkfSlam(const Settings& settings)
    : settings_(settings), covariance_(kHead, settings.most_landmarks, 2 * kMaxSightings) {
  const Eigen::Index n = kHead + 2 * settings.most_landmarks;
  error_.setZero();
  places_m_ = Eigen::VectorXd::Zero(2 * settings.most_landmarks);
  names_.reserve(static_cast<std::size_t>(settings.most_landmarks));
  innovation_covariance_ = Eigen::MatrixXd::Zero(2 * kMaxSightings, 2 * kMaxSightings);
  innovation_ = Eigen::VectorXd::Zero(2 * kMaxSightings);
  change_ = Eigen::VectorXd::Zero(n);
  lean_ = Eigen::VectorXd::Zero(n);
  start({}, PoseCovariance::Zero());
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
void EkfSlam<OdometryError, SensorError>::start(const PlanarPose& pose,
                                                const PoseCovariance& covariance) {
  pose_ = {pose.x_m, pose.y_m, wrap_angle(pose.heading_rad)};
  error_.setZero();
  names_.clear();
  lost_scans_ = 0;
  recoveries_ = 0;
  HeadMatrix head = HeadMatrix::Zero();
  head.template topLeftCorner<3, 3>() = covariance;
  if constexpr (kSensorStates > 0) {
    head.template block<kSensorStates, kSensorStates>(3, 3) =
        settings_.sensor_error.initial_covariance();
  }
  if constexpr (kOdometryStates > 0) {
    head.template bottomRightCorner<kOdometryStates, kOdometryStates>() =
        settings_.odometry_error.initial_covariance();
  }
  covariance_.restart(head);
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
void EkfSlam<OdometryError, SensorError>::predict(const OdometryStep& step) {
  // As PoseFilter::predict; the sensor's errors are states of the head too:
  //     F = [ A  0   W J ]   A = by_pose, W = by_rates, J = d rates / d e
  //         [ 0  Fs  0   ]
  //         [ 0  0   Fo  ]   noise = [ W (intensity / dt) W^T ; Qs ; Qo ]
  const Eigen::Matrix<double, kOdometryStates, 1> odometry = odometry_error();
  const auto corrected = settings_.odometry_error.corrected(step, odometry);
  const Motion motion = constant_rate_motion(pose_.heading_rad, corrected.rates, step.dt_s);
  HeadMatrix f = HeadMatrix::Identity();
  HeadMatrix noise = HeadMatrix::Zero();
  f.template topLeftCorner<3, 3>() = motion.by_pose();
  noise.template topLeftCorner<3, 3>() =
      motion.by_rates * (corrected.white_intensity / step.dt_s) * motion.by_rates.transpose();
  if constexpr (kSensorStates > 0) {
    const auto sensor = settings_.sensor_error.transition(step.dt_s);
    f.template block<kSensorStates, kSensorStates>(3, 3) = sensor.transition;
    noise.template block<kSensorStates, kSensorStates>(3, 3) = sensor.noise_covariance;
    error_.template head<kSensorStates>() =
        (sensor.transition * error_.template head<kSensorStates>()).eval();
  }
  if constexpr (kOdometryStates > 0) {
    const auto error = settings_.odometry_error.transition(step);
    f.template topRightCorner<3, kOdometryStates>() = motion.by_rates * corrected.by_error;
    f.template bottomRightCorner<kOdometryStates, kOdometryStates>() = error.transition;
    noise.template bottomRightCorner<kOdometryStates, kOdometryStates>() = error.noise_covariance;
    error_.template tail<kOdometryStates>() = (error.transition * odometry).eval();
  }
  covariance_.predict(f, noise);
  pose_ = moved(pose_, motion);
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
void EkfSlam<OdometryError, SensorError>::move(const Eigen::Vector3d& displacement,
                                               const Eigen::Matrix3d& covariance) {
  // The displacement does not depend on the heading's error: F = I.
  HeadMatrix noise = HeadMatrix::Zero();
  noise.template topLeftCorner<3, 3>() = covariance;
  covariance_.predict(HeadMatrix::Identity(), noise);
  pose_ = {pose_.x_m + displacement.x(), pose_.y_m + displacement.y(),
           wrap_angle(pose_.heading_rad + displacement.z())};
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
int EkfSlam<OdometryError, SensorError>::index_of(int name) const {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (names_[i] == name) return static_cast<int>(i);
  }
  return -1;
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
auto EkfSlam<OdometryError, SensorError>::compare(const Sighting& sighting, int landmark) const
    -> Comparison {
  // v = c(z, e) - h(x, l);  with errors "true minus estimated":
  //     v = h_x dx + h_l dl - c_e de + c_z white
  const Eigen::Matrix<double, kSensorStates, 1> error = sensor_error();
  const auto corrected = settings_.sensor_error.corrected(sighting.measured, error);
  const PredictedSighting predicted = predicted_sighting(pose_, landmark_m(landmark));
  Comparison result;
  result.innovation = sighting_difference(corrected.seen, predicted.seen);
  result.by_head.template leftCols<3>() = predicted.by_pose;
  if constexpr (kSensorStates > 0) {
    result.by_head.template rightCols<kSensorStates>() = -corrected.by_error;
  }
  result.by_landmark = predicted.by_landmark;
  result.noise = corrected.by_measured * sighting.covariance * corrected.by_measured.transpose();
  return result;
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
Eigen::Matrix2d EkfSlam<OdometryError, SensorError>::innovation_covariance(const Comparison& a,
                                                                           int landmark_a,
                                                                           const Comparison& b,
                                                                           int landmark_b) const {
  // Ha P Hb^T over the head's and the landmarks' blocks, without noise.
  const Eigen::Matrix<double, 2, kSeen> a_head =
      a.by_head * covariance_.head_block().template topLeftCorner<kSeen, kSeen>() +
      a.by_landmark * covariance_.landmark_head(landmark_a).template leftCols<kSeen>();
  const Eigen::Matrix2d a_landmark =
      a.by_head * covariance_.landmark_head(landmark_b).template leftCols<kSeen>().transpose() +
      a.by_landmark * covariance_.between(landmark_a, landmark_b);
  return a_head * b.by_head.transpose() + a_landmark * b.by_landmark.transpose();
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
double EkfSlam<OdometryError, SensorError>::nis(const Comparison& comparison, int landmark) const {
  const Eigen::Matrix2d s =
      innovation_covariance(comparison, landmark, comparison, landmark) + comparison.noise;
  return comparison.innovation.dot(s.inverse() * comparison.innovation);
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
bool EkfSlam<OdometryError, SensorError>::refuse(const Sighting& sighting, std::size_t index,
                                                 SightingReport& report) const {
  report = SightingReport{};
  const bool is_good = sighting.measured.vector().allFinite() && sighting.measured.range_m > 0.0 &&
                       sighting.covariance.allFinite() && sighting.covariance.determinant() > 0.0;
  if (is_good && index >= kMaxSightings) report.verdict = SightingVerdict::kNoRoom;
  return !is_good || index >= kMaxSightings;
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
void EkfSlam<OdometryError, SensorError>::observe(std::span<const Sighting> sightings,
                                                  std::span<SightingReport> reports) {
  assert(reports.size() == sightings.size());
  covariance_.catch_up();
  judge_named(sightings, reports);
  if (is_lost(reports)) {
    widen_pose();
    judge_named(sightings, reports);
  }
  correct_by_used(sightings, reports);
  add_new(sightings, reports, true);
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
void EkfSlam<OdometryError, SensorError>::correct_by_used(std::span<const Sighting> sightings,
                                                          std::span<const SightingReport> reports) {
  // P H^T (a panel of two columns a sighting), S = H P H^T + R, v.
  std::array<int, kMaxSightings> landmark{};
  int used = 0;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (reports[i].verdict != SightingVerdict::kUsed) continue;
    const auto k = static_cast<std::size_t>(used);
    landmark[k] = reports[i].landmark;
    comparisons_[k] = compare(sightings[i], landmark[k]);
    ++used;
  }
  if (used == 0) return;
  auto panel = covariance_.panel(2 * used);
  for (int a = 0; a < used; ++a) {
    const auto k = static_cast<std::size_t>(a);
    const Comparison& comparison = comparisons_[k];
    innovation_.template segment<2>(2 * a) = comparison.innovation;
    panel.template middleCols<2>(2 * a) =
        covariance_.head_columns().template leftCols<kSeen>().lazyProduct(
            comparison.by_head.transpose());
    covariance_.add_landmark_columns(landmark[k], comparison.by_landmark.transpose(), 2 * a);
    for (int b = 0; b <= a; ++b) {
      const auto l = static_cast<std::size_t>(b);
      innovation_covariance_.template block<2, 2>(2 * a, 2 * b) =
          innovation_covariance(comparison, landmark[k], comparisons_[l], landmark[l]);
    }
    innovation_covariance_.template block<2, 2>(2 * a, 2 * a) += comparison.noise;
  }
  apply(2 * used);
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
void EkfSlam<OdometryError, SensorError>::apply(int rank) {
  // S = L L^T, Y = P H^T L^-T, x+ = x + Y L^-1 v, P+ = P - Y Y^T; only L's half of S is read.
  auto& s = innovation_covariance_;
  for (int k = 0; k < rank; ++k) {
    for (int j = 0; j < k; ++j) {
      for (int i = 0; i < j; ++i) s(k, j) -= s(k, i) * s(j, i);
      s(k, j) /= s(j, j);
      s(k, k) -= s(k, j) * s(k, j);
      innovation_[k] -= s(k, j) * innovation_[j];
    }
    assert(s(k, k) > 0.0);
    s(k, k) = std::sqrt(s(k, k));
    innovation_[k] /= s(k, k);
  }
  covariance_.divide_panel(rank, s);
  const auto panel = covariance_.panel(rank);
  const int n = covariance_.size();
  auto change = change_.head(n);
  change.setZero();
  for (int k = 0; k < rank; ++k) change += innovation_[k] * panel.col(k);
  turn_positions();
  covariance_.subtract(rank, 2, lean_.head(n));
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
void EkfSlam<OdometryError, SensorError>::turn_positions() {
  // Invariant error (t, xi) of a position p at the estimate p-: first order dp = xi + J p- t, J a
  // quarter turn. The correction is the exponential of (t, xi):
  //     p+ = Rot(t) p- + V(t) xi,   V(t) = [ sin t, -(1 - cos t) ; 1 - cos t, sin t ] / t
  // About the new estimate dp = xi + J p+ t: covariances lean by J (p+ - p-) for each unit of t.
  const int n = covariance_.size();
  lean_.head(n).setZero();
  const double turn = change_[2];
  const SineCosine rotation = sine_cosine(wrap_angle(turn));
  const bool is_small = std::abs(turn) < 1e-4;
  const double a = is_small ? 1.0 - turn * turn / 6.0 : rotation.sine / turn;
  const double b = is_small ? 0.5 * turn : (1.0 - rotation.cosine) / turn;
  const auto corrected = [&](const Eigen::Vector2d& p, int row) -> Eigen::Vector2d {
    const Eigen::Vector2d dp = change_.template segment<2>(row);
    if (settings_.error == ErrorKind::kTextbook) return p + dp;
    const Eigen::Vector2d xi(dp.x() + p.y() * turn, dp.y() - p.x() * turn);
    Eigen::Vector2d now(rotation.cosine * p.x() - rotation.sine * p.y() + a * xi.x() - b * xi.y(),
                        rotation.sine * p.x() + rotation.cosine * p.y() + b * xi.x() + a * xi.y());
    lean_[row] = -(now.y() - p.y());
    lean_[row + 1] = now.x() - p.x();
    return now;
  };
  const Eigen::Vector2d position = corrected(pose_.position_m(), 0);
  pose_ = {position.x(), position.y(), wrap_angle(pose_.heading_rad + turn)};
  error_ += change_.template segment<kHead - 3>(3);
  for (int i = 0; i < landmarks(); ++i) {
    places_m_.template segment<2>(2 * i) = corrected(landmark_m(i), kHead + 2 * i);
  }
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
void EkfSlam<OdometryError, SensorError>::add_new(std::span<const Sighting> sightings,
                                                  std::span<SightingReport> reports,
                                                  bool has_names) {
  // l = g(x, c(z, e)):  dl = g_x dx + g_c (c_e de + c_z white)
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    SightingReport& report = reports[i];
    if (report.verdict != SightingVerdict::kNew) continue;
    if (has_names && index_of(sightings[i].name) >= 0) {  // twice in one scan
      report.verdict = SightingVerdict::kAmbiguous;
      continue;
    }
    if (landmarks() >= settings_.most_landmarks) {
      report.verdict = SightingVerdict::kNoRoom;
      continue;
    }
    const Eigen::Matrix<double, kSensorStates, 1> error = sensor_error();
    const auto corrected = settings_.sensor_error.corrected(sightings[i].measured, error);
    const PlacedLandmark placed = placed_landmark(pose_, corrected.seen);
    Eigen::Matrix<double, 2, kHead> by_head = Eigen::Matrix<double, 2, kHead>::Zero();
    by_head.template leftCols<3>() = placed.by_pose;
    if constexpr (kSensorStates > 0) {
      by_head.template middleCols<kSensorStates>(3) = placed.by_sighting * corrected.by_error;
    }
    const Eigen::Matrix2d by_white = placed.by_sighting * corrected.by_measured;
    report.landmark = landmarks();
    places_m_.template segment<2>(2 * report.landmark) = placed.place_m;
    names_.push_back(has_names ? sightings[i].name : kNameless);
    covariance_.append(by_head, by_white * sightings[i].covariance * by_white.transpose());
  }
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
Correction EkfSlam<OdometryError, SensorError>::correct(const PlanarPose& measured,
                                                        const PoseCovariance& covariance) {
  Correction correction;
  if (const auto reason = reason_to_refuse(measured, covariance)) {
    correction.verdict = *reason;
    return correction;
  }
  covariance_.catch_up();
  const PoseCovariance r = symmetric_part(covariance);
  correction.innovation = pose_difference(measured, pose_);
  correction.innovation_covariance = pose_covariance() + r;
  correction.nis =
      correction.innovation.dot(correction.innovation_covariance.inverse() * correction.innovation);
  correction.verdict = settings_.pose_gate.passes(correction.innovation,
                                                  correction.innovation_covariance, correction.nis)
                           ? PoseVerdict::kAccepted
                           : PoseVerdict::kGated;
  if (correction.verdict == PoseVerdict::kGated) return correction;
  covariance_.panel(3) = covariance_.head_columns().template leftCols<3>();
  innovation_covariance_.template topLeftCorner<3, 3>() = correction.innovation_covariance;
  innovation_.template head<3>() = correction.innovation;
  if (settings_.error == ErrorKind::kInvariant) {
    // So that turn_positions leads to the measured place: dp = xi + J p t, z = Rot(t) p + V(t) xi.
    const double t = correction.innovation.z();
    const SineCosine rotation = sine_cosine(t);
    const double half = 0.5 * t;
    const double a =
        std::abs(t) < 1e-4 ? 1.0 - t * t / 12.0 : half * (1.0 + rotation.cosine) / rotation.sine;
    const Eigen::Vector2d p = pose_.position_m();
    const Eigen::Vector2d left(measured.x_m - rotation.cosine * p.x() + rotation.sine * p.y(),
                               measured.y_m - rotation.sine * p.x() - rotation.cosine * p.y());
    // V(t)^-1 = [ a, t/2 ; -t/2, a ],  a = (t/2) cot(t/2)
    innovation_[0] = a * left.x() + half * left.y() - p.y() * t;
    innovation_[1] = -half * left.x() + a * left.y() + p.x() * t;
  }
  apply(3);
  return correction;
}

}  // namespace nadir::fusion

#include "fusion/slam/ekf_slam_named_impl.h"
#include "fusion/slam/ekf_slam_nameless_impl.h"
