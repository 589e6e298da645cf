#include "control_client/drive/arrival_clock.h"

#include <algorithm>

namespace nadir::control_client {

using fusion::Timestamp;
using namespace std::chrono_literals;

Timestamp ArrivalClock::arrived(Timestamp stamp, Timestamp now) {
  constexpr Timestamp kSpan = 10s;
  constexpr Timestamp kFar = 50ms;
  constexpr Timestamp kLate = 500ms;
  constexpr Timestamp kFollows = 1ms;
  const Timestamp difference = now - stamp;
  if (!shift_ || difference < *shift_ - kFar) {
    restart(difference, now);
    return *shift_;
  }
  if (difference > *shift_ + kFar) {
    if (!late_since_) {
      late_since_ = now;
      smallest_late_ = difference;
    }
    smallest_late_ = std::min(smallest_late_, difference);
    if (now - *late_since_ >= kLate) restart(smallest_late_, now);
    return *shift_;
  }
  late_since_.reset();
  if (now - span_began_ > kSpan) {
    smallest_before_ = smallest_;
    smallest_ = difference;
    span_began_ = now;
  }
  smallest_ = std::min(smallest_, difference);
  const Timestamp best = std::min(smallest_, smallest_before_);
  if (best < *shift_ - kFollows || best > *shift_ + kFollows) shift_ = best;
  return *shift_;
}

void ArrivalClock::restart(Timestamp difference, Timestamp now) {
  shift_ = smallest_ = smallest_before_ = difference;
  span_began_ = now;
  late_since_.reset();
}

}  // namespace nadir::control_client
