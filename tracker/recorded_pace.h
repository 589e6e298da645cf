#pragma once

#include <algorithm>
#include <chrono>
#include <optional>
#include <stop_token>
#include <thread>

#include "vision/frame.h"

namespace nadir::tracker {

/// Replays a recording as it was captured: the first frame at once, each later one as long after it
/// as its capture time says. A capture time that goes back starts anew.
class RecordedPace {
 public:
  using Clock = std::chrono::steady_clock;

  /// When a frame is due that was read at `now`.
  Clock::time_point due(vision::CaptureTime capture_time, Clock::time_point now) {
    if (!last_ || capture_time < *last_) {
      first_ = capture_time;
      start_ = now;
    }
    last_ = capture_time;
    return start_ + std::chrono::duration_cast<Clock::duration>(capture_time - first_);
  }

  /// Sleeps until the frame is due or a stop is asked for.
  void wait(vision::CaptureTime capture_time, const std::stop_token& stop) {
    constexpr std::chrono::milliseconds kLongestNap{20};  // so that a stop does not have to wait
    const Clock::time_point until = due(capture_time, Clock::now());
    for (auto now = Clock::now(); now < until && !stop.stop_requested(); now = Clock::now()) {
      std::this_thread::sleep_for(std::min<Clock::duration>(until - now, kLongestNap));
    }
  }

 private:
  vision::CaptureTime first_{};
  std::optional<vision::CaptureTime> last_;
  Clock::time_point start_{};
};

}  // namespace nadir::tracker
