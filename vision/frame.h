#pragma once

#include <chrono>
#include <cstdint>
#include <opencv2/core.hpp>

namespace nadir::vision {

/// Wall-clock time with nanosecond ticks since the Unix epoch.
using CaptureTime = std::chrono::time_point<std::chrono::system_clock, std::chrono::nanoseconds>;

/// One picture of one camera.
struct Frame {
  std::uint64_t number = 0;  ///< counts the camera's frames from 0; a lost frame leaves a gap
  CaptureTime capture_time;  ///< middle of the exposure
  cv::Mat image;             ///< CV_8UC3, blue green red
};

}  // namespace nadir::vision
