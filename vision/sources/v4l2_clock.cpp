#include "vision/sources/v4l2_clock.h"

#include <linux/videodev2.h>

namespace nadir::vision {

CaptureTime unix_time_from_monotonic(V4l2System& system, std::chrono::nanoseconds monotonic) {
  using std::chrono::nanoseconds;
  // If the scheduler steps in between the readings their difference is wrong: take the tightest of
  // a few.
  constexpr int kReadings = 5;
  constexpr nanoseconds kTight = std::chrono::microseconds(2);
  nanoseconds best_gap = nanoseconds::max();
  nanoseconds offset{0};
  for (int i = 0; i < kReadings && best_gap > kTight; ++i) {
    const nanoseconds before = system.monotonic_now();
    const nanoseconds unix_time = system.unix_now();
    const nanoseconds gap = system.monotonic_now() - before;
    if (gap >= best_gap) continue;
    best_gap = gap;
    offset = unix_time - (before + gap / 2);
  }
  return CaptureTime(monotonic + offset);
}

CaptureTime capture_time_of(V4l2System& system, const v4l2_buffer& picture,
                            std::chrono::nanoseconds exposure) {
  const bool is_monotonic =
      (picture.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  if (!is_monotonic) return CaptureTime(system.unix_now()) - exposure / 2;
  const std::chrono::nanoseconds stamp = std::chrono::seconds(picture.timestamp.tv_sec) +
                                         std::chrono::microseconds(picture.timestamp.tv_usec);
  const CaptureTime time = unix_time_from_monotonic(system, stamp);
  const bool marks_start =
      (picture.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  return marks_start ? time + exposure / 2 : time - exposure / 2;
}

}  // namespace nadir::vision
