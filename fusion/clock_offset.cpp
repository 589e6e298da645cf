#include "fusion/clock_offset.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nadir::fusion {
namespace {

constexpr double kPerMillion = 1e-6;

}  // namespace

ClockVerdict ClockOffset::add(const ClockExchange& exchange) {
  const ClockVerdict verdict = judge(exchange);
  ++counts_.at(static_cast<std::size_t>(verdict));
  return verdict;
}

ClockVerdict ClockOffset::judge(const ClockExchange& exchange) {
  const Timestamp zero{0};
  if (exchange.robot_sent <= zero || exchange.server_received <= zero ||
      exchange.server_sent <= zero || exchange.robot_received <= zero) {
    return ClockVerdict::kImpossible;
  }
  const auto away = exchange.robot_received - exchange.robot_sent;
  const auto answering = exchange.server_sent - exchange.server_received;
  const auto round_trip = away - answering;
  if (away < zero || answering < zero || round_trip < zero) return ClockVerdict::kImpossible;
  if (round_trip > settings_.slowest) return ClockVerdict::kTooSlow;

  // Halves first: the offset between a steady clock and the Unix epoch fills 61 bits.
  Sample sample;
  sample.time = exchange.robot_sent + away / 2;
  sample.offset = (exchange.server_received - exchange.robot_sent) / 2 +
                  (exchange.server_sent - exchange.robot_received) / 2;
  sample.round_trip_s = to_seconds(round_trip);
  if (size_ > 0 && contradicts(sample)) return keep_aside(sample);
  aside_size_ = 0;
  return keep(sample);
}

ClockVerdict ClockOffset::keep(const Sample& sample) {
  if (size_ > 0) {
    Sample& newest = samples_.at((first_ + size_ - 1) % kSpans);
    if (newest.time.count() / settings_.span.count() ==
        sample.time.count() / settings_.span.count()) {
      if (newest.round_trip_s <= sample.round_trip_s) return ClockVerdict::kSlower;
      newest = sample;
      fit();
      return ClockVerdict::kUsed;
    }
  }
  if (size_ == kSpans) {
    first_ = (first_ + 1) % kSpans;
    --size_;
  }
  samples_.at((first_ + size_) % kSpans) = sample;
  ++size_;
  fit();
  return ClockVerdict::kUsed;
}

ClockVerdict ClockOffset::keep_aside(const Sample& sample) {
  if (aside_size_ > 0 && !agree(aside_.at(aside_size_ - 1), sample)) aside_size_ = 0;
  if (aside_size_ < kAside) aside_.at(aside_size_++) = sample;
  if (static_cast<int>(aside_size_) < std::min(settings_.step_after, static_cast<int>(kAside))) {
    return ClockVerdict::kContradicts;
  }
  size_ = 0;
  for (std::size_t i = 0; i < aside_size_; ++i) keep(aside_.at(i));
  aside_size_ = 0;
  return ClockVerdict::kStepped;
}

bool ClockOffset::contradicts(const Sample& sample) const {
  const Interval possible = possible_at(sample.time);
  const double offset_s = to_seconds(sample.offset - line_.base);
  const double reach_s = 0.5 * sample.round_trip_s + settings_.stamp_sigma_s;
  return offset_s - reach_s > possible.high_s || offset_s + reach_s < possible.low_s;
}

bool ClockOffset::agree(const Sample& a, const Sample& b) const {
  const double apart_s = std::abs(to_seconds(b.offset - a.offset));
  const double elapsed_s = std::abs(to_seconds(b.time - a.time));
  return apart_s <= 0.5 * (a.round_trip_s + b.round_trip_s) + settings_.stamp_sigma_s +
                        settings_.largest_drift_ppm * kPerMillion * elapsed_s;
}

double ClockOffset::drift_tolerance() const {
  const double known = 3.0 * std::sqrt(line_.drift_variance);
  const double largest = settings_.largest_drift_ppm * kPerMillion + std::abs(line_.drift);
  return std::min(known + settings_.drift_wander_ppm * kPerMillion, largest);
}

double ClockOffset::line_at(Timestamp time) const {
  return line_.offset_s + line_.drift * to_seconds(time - line_.time);
}

ClockOffset::Interval ClockOffset::possible_at(Timestamp time) const {
  const double tolerance = drift_tolerance();
  Interval possible = {-std::numeric_limits<double>::infinity(),
                       std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < size_; ++i) {
    const Sample& sample = samples_.at((first_ + i) % kSpans);
    const double elapsed_s = to_seconds(time - sample.time);
    const double middle_s = to_seconds(sample.offset - line_.base) + line_.drift * elapsed_s;
    const double reach_s =
        0.5 * sample.round_trip_s + settings_.stamp_sigma_s + tolerance * std::abs(elapsed_s);
    possible.low_s = std::max(possible.low_s, middle_s - reach_s);
    possible.high_s = std::min(possible.high_s, middle_s + reach_s);
  }
  return possible;
}

void ClockOffset::fit() {
  // Weighted least squares of offset = a + d t, t from the newest sample, where d has the expected
  // drift as a prior. A sample's error: its stamps, half of what its round trip took beyond the
  // shortest, and what the drift has changed since.
  const Sample& newest = samples_.at((first_ + size_ - 1) % kSpans);
  line_.time = newest.time;
  line_.base = newest.offset;
  double shortest_s = newest.round_trip_s;
  for (std::size_t i = 0; i < size_; ++i) {
    shortest_s = std::min(shortest_s, samples_.at((first_ + i) % kSpans).round_trip_s);
  }
  const double prior = settings_.expected_drift_ppm * kPerMillion;
  double s0 = 0.0;
  double s1 = 0.0;
  double s2 = 1.0 / (prior * prior);
  double b0 = 0.0;
  double b1 = 0.0;
  double waiting = 0.0;
  for (std::size_t i = 0; i < size_; ++i) {
    const Sample& sample = samples_.at((first_ + i) % kSpans);
    const double t_s = to_seconds(sample.time - line_.time);
    const double y_s = to_seconds(sample.offset - line_.base);
    const double waited_s = 0.5 * (sample.round_trip_s - shortest_s);
    const double wander_s = settings_.drift_wander_ppm * kPerMillion * t_s;
    const double weight = 1.0 / (settings_.stamp_sigma_s * settings_.stamp_sigma_s +
                                 waited_s * waited_s + wander_s * wander_s);
    s0 += weight;
    s1 += weight * t_s;
    s2 += weight * t_s * t_s;
    b0 += weight * y_s;
    b1 += weight * t_s * y_s;
    waiting += weight * waited_s;
  }
  const double determinant = s0 * s2 - s1 * s1;
  line_.offset_s = (s2 * b0 - s1 * b1) / determinant;
  line_.drift = (s0 * b1 - s1 * b0) / determinant;
  line_.offset_variance = s2 / determinant;
  line_.covariance = -s1 / determinant;
  line_.drift_variance = s0 / determinant;
  line_.waiting_s = waiting / s0;
}

std::optional<ClockReading> ClockOffset::at(Timestamp robot_time) const {
  if (size_ == 0) return std::nullopt;
  const Interval possible = possible_at(robot_time);
  double offset_s = line_at(robot_time);
  if (possible.low_s <= possible.high_s) {
    offset_s = std::clamp(offset_s, possible.low_s, possible.high_s);
  }
  const double t_s = to_seconds(robot_time - line_.time);
  const double wander_s = settings_.drift_wander_ppm * kPerMillion * t_s;
  // Waiting is always on the same side, so it does not average out.
  const double variance = line_.offset_variance + 2.0 * line_.covariance * t_s +
                          line_.drift_variance * t_s * t_s + line_.waiting_s * line_.waiting_s +
                          wander_s * wander_s;
  ClockReading reading;
  reading.offset = line_.base + from_seconds(offset_s);
  reading.drift_ppm = line_.drift / kPerMillion;
  reading.sigma_s = std::sqrt(std::max(variance, 0.0));
  reading.drift_sigma_ppm = std::sqrt(line_.drift_variance) / kPerMillion;
  reading.bound_s = std::max(possible.high_s - offset_s, offset_s - possible.low_s);
  return reading;
}

std::optional<Timestamp> ClockOffset::robot_time(Timestamp server_time) const {
  // robot = server - offset(robot); the offset changes by parts per million, so that the second
  // guess is exact.
  if (size_ == 0) return std::nullopt;
  Timestamp robot = server_time - at(line_.time)->offset;
  for (int i = 0; i < 2; ++i) robot = server_time - at(robot)->offset;
  return robot;
}

}  // namespace nadir::fusion
