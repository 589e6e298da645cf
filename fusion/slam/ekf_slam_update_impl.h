#pragma once

// The functions of EkfSlam that change pose and map by what was seen; included by its header alone.

#include <array>
#include <cassert>
#include <cmath>

#include "fusion/sine_cosine.h"
#include "fusion/slam/ekf_slam.h"

namespace nadir::fusion {

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

}  // namespace nadir::fusion
