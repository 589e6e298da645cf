#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "vision/frame_source.h"

namespace nadir::vision {

/// A recording as a video file, in any format that OpenCV's video back ends read.
///
/// A frame was taken at start_time + its position in the container. Where the container gives no
/// position that increases from frame to frame, rate_hz spaces the frames instead.
class VideoFile final : public FrameSource {
 public:
  /// @param rate_hz  frames a second, above 0
  /// Throws InputError if the file is absent or is no video.
  VideoFile(const std::filesystem::path& file, double rate_hz, CaptureTime start_time);
  ~VideoFile() override;

  ReadResult read(Frame& frame) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nadir::vision
