#include "control_client/drive/odometry_merger.h"

#include <utility>

namespace nadir::control_client {

std::optional<OdometryInterval> OdometryMerger::add(const OdometryInterval& next) {
  constexpr std::chrono::nanoseconds kJitter = std::chrono::microseconds(100);
  if (!joined_) {
    joined_ = next;
    return std::nullopt;
  }
  const std::chrono::nanoseconds gap = next.from - joined_->to;
  if (next.to <= joined_->to || gap > kJitter || gap < -kJitter) {
    return std::exchange(joined_, next);
  }
  const double before_s = fusion::to_seconds(joined_->to - joined_->from);
  const double next_s = fusion::to_seconds(next.to - joined_->to);
  joined_->mean_rates = fusion::BodyRates::from(
      (before_s * joined_->mean_rates.vector() + next_s * next.mean_rates.vector()) /
      (before_s + next_s));
  joined_->to = next.to;
  return std::nullopt;
}

std::optional<OdometryInterval> OdometryMerger::take() {
  return std::exchange(joined_, std::nullopt);
}

}  // namespace nadir::control_client
