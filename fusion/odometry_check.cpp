#include "fusion/odometry_check.h"

#include <cmath>

namespace nadir::fusion {

std::optional<OdometryVerdict> reason_to_refuse(Timestamp from, Timestamp to,
                                                const BodyRates& mean_rates,
                                                const OdometryCheck& check) {
  const bool is_sensible = std::abs(mean_rates.u_mps) <= check.fastest_mps &&
                           std::abs(mean_rates.v_mps) <= check.fastest_mps &&
                           std::abs(mean_rates.r_radps) <= check.fastest_radps;
  if (!is_sensible) return OdometryVerdict::kNotFinite;
  if (from.count() <= 0 || to.count() <= 0) return OdometryVerdict::kZeroStamp;
  if (to <= from) return OdometryVerdict::kEmpty;
  if (to - from > check.longest_interval) return OdometryVerdict::kTooLong;
  return std::nullopt;
}

OdometryVerdict OdometryClock::compare(Timestamp now, Timestamp from, Timestamp to,
                                       const OdometryCheck& check) {
  const bool is_behind = to <= now;
  const bool is_ahead = from - now > check.longest_gap;
  if (!is_behind && !is_ahead) {
    off_time_ = 0;
    return from - now > check.join_tolerance ? OdometryVerdict::kUsedAfterGap
                                             : OdometryVerdict::kUsed;
  }
  const bool follows = off_time_ > 0 && to > last_to_ && from - last_to_ <= check.longest_interval;
  if (!follows) run_began_ = from;
  off_time_ = follows ? off_time_ + 1 : 1;
  last_to_ = to;
  if (off_time_ >= check.restart_after) {
    off_time_ = 0;
    return OdometryVerdict::kClockRestarted;
  }
  return is_behind ? OdometryVerdict::kBehind : OdometryVerdict::kAhead;
}

}  // namespace nadir::fusion
