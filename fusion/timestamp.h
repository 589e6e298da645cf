#pragma once

#include <chrono>
#include <cmath>

namespace nadir::fusion {

/// A point in time: nanoseconds since the Unix epoch, or since any other instant that odometry and
/// poses have in common. Zero stands for a stamp that nobody set.
using Timestamp = std::chrono::nanoseconds;

/// Length of a span of time, s.
inline double to_seconds(std::chrono::nanoseconds span) {
  return 1e-9 * static_cast<double>(span.count());
}

/// The span of so many seconds, rounded to nanoseconds; |span| below 292 years.
inline std::chrono::nanoseconds from_seconds(double span_s) {
  return std::chrono::nanoseconds(std::llround(span_s * 1e9));
}

}  // namespace nadir::fusion
