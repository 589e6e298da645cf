#pragma once

#include <chrono>

#include "vision/frame.h"
#include "vision/sources/v4l2_system.h"

struct v4l2_buffer;

namespace nadir::vision {

/// A moment of the monotonic clock as Unix time, by the difference that the two clocks have now.
CaptureTime unix_time_from_monotonic(V4l2System& system, std::chrono::nanoseconds monotonic);

/// Middle of the exposure of a picture that the driver handed over.
///
/// The driver says whether its stamp marks the start of the exposure or the end of the frame. From
/// the first, half the exposure time is added; from the second it is taken off. What the sensor
/// needs to read the frame out is not known to V4L2 and stays in the second kind as a constant
/// delay. A driver without monotonic stamps gets the time at which its picture was fetched, as an
/// end of the frame.
/// @param exposure  0 where the camera does not say
CaptureTime capture_time_of(V4l2System& system, const v4l2_buffer& picture,
                            std::chrono::nanoseconds exposure);

}  // namespace nadir::vision
