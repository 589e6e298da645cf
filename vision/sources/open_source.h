#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "vision/frame_source.h"
#include "vision/synthetic/live_robots.h"

namespace nadir::vision {

/// What a source's name does not say.
struct SourceOptions {
  double rate_hz = 30.0;     ///< of a recording without times; a camera is asked for this rate
  CaptureTime start_time{};  ///< of the first frame of a recording without times
  int width_px = 0;          ///< asked of a camera; 0 leaves the choice to it
  int height_px = 0;         ///< asked of a camera; 0 leaves the choice to it
  std::uint64_t seed = 1;    ///< of everything random in a synthetic scene
  /// A synthetic scene behaves like a camera: its rate, wall-clock times, late readers lose frames.
  /// Otherwise it is a recording: as fast as it is read, with the scene's own times.
  bool synthetic_in_real_time = false;
  /// Who knows the live robots of a synthetic scene; called only for a scene that has some, which
  /// then is a camera. hold_s: a robot not heard of for longer is gone.
  std::function<std::shared_ptr<LiveRobots>(double hold_s)> live_robots;
};

/// Opens what a user names: a folder of images, a video file, `v4l2:/dev/video0` or
/// `synthetic:SCENE.yaml`. Throws InputError for an unknown scheme, a path that does not exist, and
/// whatever can never work. A camera that is not there is no error: it may come.
std::unique_ptr<FrameSource> open_source(const std::string& source,
                                         const SourceOptions& options = {});

}  // namespace nadir::vision
