#pragma once

#include <cmath>
#include <cstdint>

#include "vision/frame.h"

namespace nadir::vision {

/// When frame `index` of a recording at a steady rate was taken: start_time + index / rate_hz, to
/// the nanosecond.
inline CaptureTime regular_capture_time(CaptureTime start_time, std::uint64_t index,
                                        double rate_hz) {
  // A recording of a year has 3e16 ns, beyond the 53 bits of double; long double carries 64.
  const long double since_start_ns = static_cast<long double>(index) * 1e9L / rate_hz;
  return start_time + std::chrono::nanoseconds(std::llround(since_start_ns));
}

}  // namespace nadir::vision
