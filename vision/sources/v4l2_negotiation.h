#pragma once

#include <chrono>
#include <functional>

#include "vision/sources/v4l2_pixels.h"

namespace nadir::vision {

struct V4l2Request;

/// What a camera and nadir agreed on.
struct V4l2Agreement {
  V4l2PixelLayout layout;
  std::chrono::nanoseconds frame_interval{0};
};

/// ioctl on the opened device: 0 or a negative errno value.
using V4l2Control = std::function<int(std::uint32_t request, void* argument)>;

/// Tries the camera's formats from the best to the worst and keeps the first that has the size and
/// at least nine tenths of the rate that are asked for; if none has, the best one as the camera
/// offers it. Throws std::runtime_error with one line where the device is no camera or no format of
/// it is known.
V4l2Agreement negotiate(const V4l2Control& control, const V4l2Request& request);

/// The exposure time, 0 where the camera does not tell it.
std::chrono::nanoseconds read_exposure(const V4l2Control& control);

}  // namespace nadir::vision
