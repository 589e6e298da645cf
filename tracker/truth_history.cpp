#include "tracker/truth_history.h"

#include <algorithm>

namespace nadir::tracker {
namespace {

constexpr std::int64_t kKept_ns = 2'000'000'000;
constexpr std::size_t kMostSamples = 4096;
constexpr std::int64_t kLongestExtrapolation_ns = 50'000'000;

/// One coordinate between two samples, and its rate of change.
struct Interpolated {
  double value = 0.0;
  double rate = 0.0;
};

/// The cubic with value 0 and rate `from_rate` at share 0, `change` and `to_rate` at share 1.
Interpolated cubic(double change, double from_rate, double to_rate, double share, double length_s) {
  const double from = from_rate * length_s;
  const double to = to_rate * length_s;
  const double square = 3.0 * change - 2.0 * from - to;
  const double cube = from + to - 2.0 * change;
  return {.value = share * (from + share * (square + share * cube)),
          .rate = (from + share * (2.0 * square + 3.0 * share * cube)) / length_s};
}

vision::RobotMotion between(const WireSimulatedTruth& a, const WireSimulatedTruth& b,
                            std::int64_t time_ns) {
  const double length_s = 1e-9 * static_cast<double>(b.time_ns - a.time_ns);
  const double share = 1e-9 * static_cast<double>(time_ns - a.time_ns) / length_s;
  const Eigen::Vector3d change = fusion::pose_difference(b.pose_world_robot, a.pose_world_robot);
  const Interpolated x = cubic(change[0], a.velocity_x_mps, b.velocity_x_mps, share, length_s);
  const Interpolated y = cubic(change[1], a.velocity_y_mps, b.velocity_y_mps, share, length_s);
  const Interpolated heading =
      cubic(change[2], a.heading_rate_radps, b.heading_rate_radps, share, length_s);
  return {.x_m = a.pose_world_robot.x_m + x.value,
          .y_m = a.pose_world_robot.y_m + y.value,
          .heading_rad = fusion::wrap_angle(a.pose_world_robot.heading_rad + heading.value),
          .velocity_x_mps = x.rate,
          .velocity_y_mps = y.rate,
          .heading_rate_radps = heading.rate};
}

vision::RobotMotion beyond(const WireSimulatedTruth& last, std::int64_t time_ns) {
  const std::int64_t ahead_ns = time_ns - last.time_ns;
  const bool rests = ahead_ns > kLongestExtrapolation_ns;
  const double ahead_s = 1e-9 * static_cast<double>(std::min(ahead_ns, kLongestExtrapolation_ns));
  return {.x_m = last.pose_world_robot.x_m + ahead_s * last.velocity_x_mps,
          .y_m = last.pose_world_robot.y_m + ahead_s * last.velocity_y_mps,
          .heading_rad = fusion::wrap_angle(last.pose_world_robot.heading_rad +
                                            ahead_s * last.heading_rate_radps),
          .velocity_x_mps = rests ? 0.0 : last.velocity_x_mps,
          .velocity_y_mps = rests ? 0.0 : last.velocity_y_mps,
          .heading_rate_radps = rests ? 0.0 : last.heading_rate_radps};
}

bool is_earlier(const WireSimulatedTruth& sample, std::int64_t time_ns) {
  return sample.time_ns < time_ns;
}

}  // namespace

void TruthHistory::add(const WireSimulatedTruth& truth) {
  if (truth.epoch != epoch_) samples_.clear();
  epoch_ = truth.epoch;
  const auto place = std::lower_bound(samples_.begin(), samples_.end(), truth.time_ns, is_earlier);
  if (place != samples_.end() && place->time_ns == truth.time_ns) {
    *place = truth;
  } else {
    samples_.insert(place, truth);
  }
  while (samples_.back().time_ns - samples_.front().time_ns > kKept_ns ||
         samples_.size() > kMostSamples) {
    samples_.pop_front();
  }
}

std::optional<vision::RobotMotion> TruthHistory::at(std::int64_t time_ns,
                                                    std::chrono::nanoseconds hold) const {
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), time_ns, is_earlier);
  if (after != samples_.end() && after->time_ns == time_ns) return beyond(*after, time_ns);
  if (after == samples_.begin()) return std::nullopt;
  const WireSimulatedTruth& before = *(after - 1);
  // Over a gap that is too long nobody knows the way.
  if (after != samples_.end() && after->time_ns - before.time_ns <= hold.count()) {
    return between(before, *after, time_ns);
  }
  if (time_ns - before.time_ns > hold.count()) return std::nullopt;
  return beyond(before, time_ns);
}

std::optional<std::int64_t> TruthHistory::newest_ns() const {
  if (samples_.empty()) return std::nullopt;
  return samples_.back().time_ns;
}

}  // namespace nadir::tracker
