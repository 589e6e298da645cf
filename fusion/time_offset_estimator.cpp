#include "fusion/time_offset_estimator.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace nadir::fusion {
namespace {

/// World velocity, order x, y, heading.
Eigen::Vector3d world_velocity(double heading_rad, const BodyRates& rates) {
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  return {c * rates.u_mps - s * rates.v_mps, s * rates.u_mps + c * rates.v_mps, rates.r_radps};
}

}  // namespace

void TimeOffsetEstimator::restart(const PlanarPose& pose, const Eigen::Vector3d& velocity) {
  // The filter stands where the frame says, which is p - p' tau.
  has_started_ = true;
  pose_ = pose;
  by_offset_ = -velocity;
}

void TimeOffsetEstimator::add(Timestamp capture, const PlanarPose& measured,
                              const PoseCovariance& covariance, const Correction& correction,
                              const BodyRates& nominal_rates) {
  if (!is_used(correction.verdict) || !nominal_rates.is_finite()) return;
  const double elapsed_s = to_seconds(capture - last_);
  const bool is_in_order = elapsed_s > 0.0 || elapsed_s < -settings_.longest_gap_s;
  if (has_started_ && !is_in_order) return;
  last_ = capture;
  const Eigen::Vector3d velocity = world_velocity(measured.heading_rad, nominal_rates);
  if (!has_started_ || correction.verdict != PoseVerdict::kAccepted ||
      std::abs(elapsed_s) > settings_.longest_gap_s) {
    if (span_information_ == 0.0) span_began_ = capture;
    restart(measured, velocity);
    return;
  }
  const Eigen::Vector3d& e = correction.innovation;
  const PlanarPose predicted = {measured.x_m - e.x(), measured.y_m - e.y(),
                                wrap_angle(measured.heading_rad - e.z())};
  // F: a heading that is off by s_h turns the way since the last correction.
  Eigen::Vector3d s = by_offset_;
  s.x() -= (predicted.y_m - pose_.y_m) * by_offset_.z();
  s.y() += (predicted.x_m - pose_.x_m) * by_offset_.z();
  const Eigen::Vector3d phi = -velocity - s;
  const Eigen::Matrix3d inverse = correction.innovation_covariance.inverse();
  const Eigen::Matrix3d gain = (correction.innovation_covariance - covariance) * inverse;
  by_offset_ = s + gain * phi;
  const Eigen::Vector3d change = gain * e;
  pose_ = {predicted.x_m + change.x(), predicted.y_m + change.y(),
           wrap_angle(predicted.heading_rad + change.z())};

  span_information_ += phi.dot(inverse * phi);
  span_vector_ += phi.dot(inverse * e);
  if (to_seconds(capture - span_began_) >= settings_.span_s) {
    close_span();
    span_began_ = capture;
  }
}

void TimeOffsetEstimator::close_span() {
  const double kept = std::exp(-settings_.span_s / settings_.memory_s);
  information_ = kept * information_ + span_information_;
  vector_ = kept * vector_ + span_vector_;
  vector_squared_ = kept * vector_squared_ + span_vector_ * span_vector_;
  product_ = kept * product_ + span_vector_ * span_information_;
  information_squared_ = kept * information_squared_ + span_information_ * span_information_;
  spans_ = kept * spans_ + 1.0;
  span_information_ = span_vector_ = 0.0;
}

std::optional<TimeOffsetReading> TimeOffsetEstimator::reading() const {
  // Less than a second's worth of knowledge is none.
  if (spans_ < 1.0 || information_ < 1.0) return std::nullopt;
  const double offset_s = vector_ / information_;
  // sum (b_i - I_i tau)^2 over spans, divided by I^2: the variance of tau whatever the errors' law.
  const double scatter =
      vector_squared_ - 2.0 * offset_s * product_ + offset_s * offset_s * information_squared_;
  double variance = 1.0 / information_;
  if (spans_ > 2.0) {
    variance =
        std::max(variance, scatter * spans_ / (spans_ - 1.0) / (information_ * information_));
  }
  return TimeOffsetReading{offset_s, std::sqrt(variance)};
}

}  // namespace nadir::fusion
