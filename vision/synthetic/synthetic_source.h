#pragma once

#include <chrono>
#include <cstdint>

#include "vision/frame_source.h"
#include "vision/synthetic/renderer.h"

namespace nadir::vision {

/// How fast a synthetic camera delivers.
enum class SyntheticPace {
  kFastest,   ///< as fast as frames can be made; capture times from the scene's fixed epoch
  kRecorded,  ///< at the scene's rate, none left out; capture times from the fixed epoch
  kRealTime,  ///< like a camera: capture times are wall-clock times, frames that nobody fetched in
              ///< time are lost
};

/// A scene as a frame source. It can start and continue at any frame.
class SyntheticSource : public FrameSource {
 public:
  /// Ends after Scene::frames frames, never if that is 0. Throws InputError for a scene that cannot
  /// be shown.
  SyntheticSource(Scene scene, std::uint64_t seed, SyntheticPace pace = SyntheticPace::kFastest);

  ReadResult read(Frame& frame) override;
  bool is_live() const override { return pace_ == SyntheticPace::kRealTime; }

  /// The next frame that read will deliver (real time: at the earliest).
  void seek(std::uint64_t frame_number);
  /// Truth of any frame.
  const Renderer& renderer() const { return renderer_; }

 private:
  /// Waits for the next frame's time; in real time it may pass over frames.
  void keep_pace();

  Renderer renderer_;
  SyntheticPace pace_;
  std::uint64_t next_ = 0;
  bool started_ = false;
  std::uint64_t first_ = 0;  ///< frame at start_
  std::chrono::steady_clock::time_point start_;
  CaptureTime start_wall_;
};

}  // namespace nadir::vision
