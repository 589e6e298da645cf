#include "fusion/heading_filter.h"

#include <algorithm>
#include <cmath>

namespace nadir::fusion {

void HeadingFilter::start(double heading_rad, double heading_variance_rad2,
                          double bias_variance_rad2ps2) {
  state_ = {heading_rad, 0.0};
  covariance_ = Eigen::Vector2d(heading_variance_rad2, bias_variance_rad2ps2).asDiagonal();
  time_s_ = 0.0;
  gyro_rad_ = 0.0;
  newest_ = 0;
  remembered_ = 1;
  turns_[0] = {};
  sources_ = {};
}

void HeadingFilter::predict(double gyro_radps, double dt_s) {
  state_(0) += dt_s * (gyro_radps - state_(1));
  Eigen::Matrix2d transition;
  transition << 1.0, -dt_s, 0.0, 1.0;
  covariance_ = transition * covariance_ * transition.transpose();
  // White noise of the gyro: the variances of steps add up to that of one long step.
  covariance_(0, 0) += settings_.gyro_variance_rad2ps2 * settings_.sample_s * dt_s;
  covariance_(1, 1) += settings_.bias_walk_rad2ps3 * dt_s;
  time_s_ += dt_s;
  gyro_rad_ += dt_s * gyro_radps;
  newest_ = (newest_ + 1) % kTurns;
  remembered_ = std::min(remembered_ + 1, kTurns);
  turns_[newest_] = {time_s_, gyro_rad_};
}

std::optional<double> HeadingFilter::gyro_turn_since(double time_s) const {
  Turn later = turns_[newest_];
  if (time_s >= later.time_s) return 0.0;
  for (std::size_t back = 1; back < remembered_; ++back) {
    const Turn& earlier = turns_[(newest_ + kTurns - back) % kTurns];
    if (earlier.time_s <= time_s) {
      const double share = (time_s - earlier.time_s) / (later.time_s - earlier.time_s);
      return gyro_rad_ - (earlier.gyro_rad + share * (later.gyro_rad - earlier.gyro_rad));
    }
    later = earlier;
  }
  return std::nullopt;
}

HeadingVerdict HeadingFilter::correct(HeadingSource source, double heading_rad,
                                      double variance_rad2, double age_s) {
  if (!std::isfinite(heading_rad) || !(variance_rad2 > 0.0) || !(age_s >= 0.0)) {
    return HeadingVerdict::kRefused;
  }
  const auto turn_rad = gyro_turn_since(time_s_ - age_s);
  if (!turn_rad) return HeadingVerdict::kRefused;
  // theta(t - age) + turn of the gyro = theta(t) + age b
  const Eigen::RowVector2d observation(1.0, age_s);
  const double innovation_rad = wrap_angle(heading_rad + *turn_rad - observation.dot(state_));
  const double noise_rad2 =
      variance_rad2 + settings_.gyro_variance_rad2ps2 * settings_.sample_s * age_s;
  const double expected_rad2 = observation * covariance_ * observation.transpose() + noise_rad2;
  SourceRecord& record = sources_.at(static_cast<std::size_t>(source));
  HeadingVerdict verdict = HeadingVerdict::kAccepted;
  if (settings_.gate_nis > 0.0 &&
      innovation_rad * innovation_rad > settings_.gate_nis * expected_rad2) {
    if (!is_recovered(source, innovation_rad, noise_rad2)) return HeadingVerdict::kGated;
    covariance_(0, 0) += innovation_rad * innovation_rad;
    verdict = HeadingVerdict::kRecovered;
  }
  record.gated_in_a_row = 0;
  record.last_accepted_s = time_s_;
  update(observation, innovation_rad, noise_rad2);
  return verdict;
}

bool HeadingFilter::is_recovered(HeadingSource source, double innovation_rad,
                                 double variance_rad2) {
  constexpr double kSigmas = 4.0;
  SourceRecord& record = sources_.at(static_cast<std::size_t>(source));
  const double change_rad = std::abs(wrap_angle(innovation_rad - record.last_gated_rad));
  const bool says_the_same = change_rad <= kSigmas * std::sqrt(2.0 * variance_rad2);
  record.gated_in_a_row = says_the_same ? record.gated_in_a_row + 1 : 1;
  record.last_gated_rad = innovation_rad;
  for (const SourceRecord& other : sources_) {
    const bool is_trusted = &other != &record && other.last_accepted_s &&
                            time_s_ - *other.last_accepted_s <= settings_.trusted_s;
    if (is_trusted) return false;
  }
  return settings_.recover_after > 0 && record.gated_in_a_row >= settings_.recover_after;
}

void HeadingFilter::update(const Eigen::RowVector2d& observation, double innovation_rad,
                           double variance_rad2) {
  const double expected_rad2 = observation * covariance_ * observation.transpose() + variance_rad2;
  gain_ = covariance_ * observation.transpose() / expected_rad2;
  state_ += gain_ * innovation_rad;
  // Joseph's form stays positive definite.
  const Eigen::Matrix2d keep = Eigen::Matrix2d::Identity() - gain_ * observation;
  covariance_ = keep * covariance_ * keep.transpose() + variance_rad2 * gain_ * gain_.transpose();
}

}  // namespace nadir::fusion
