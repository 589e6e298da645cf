#include "vision/sources/video_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "vision/input/input_error.h"
#include "vision/pictures/codecs.h"

namespace nadir::vision {

struct VideoFile::State {
  std::unique_ptr<VideoReader> video;
  CaptureTime start_time;
  std::chrono::nanoseconds frame_interval;
  std::chrono::nanoseconds position{-1};  ///< of the last frame, from the start of the file
  std::uint64_t next_number = 0;

  std::chrono::nanoseconds next_position() const {
    const double from_container_ms = video->position_ms();
    if (next_number == 0) {
      return std::chrono::nanoseconds(std::llround(std::max(0.0, from_container_ms) * 1e6));
    }
    if (std::isfinite(from_container_ms)) {
      const std::chrono::nanoseconds here(std::llround(from_container_ms * 1e6));
      if (here > position) return here;
    }
    return position + frame_interval;
  }
};

VideoFile::VideoFile(const std::filesystem::path& file, double rate_hz, CaptureTime start_time)
    : state_(std::make_unique<State>()) {
  if (!std::ifstream(file)) {
    throw InputError({file.string()}, "cannot be opened", "check the path and the permissions");
  }
  state_->video = codecs().open_video(file.string());
  if (state_->video == nullptr) {
    throw InputError({file.string()}, "is not a video that can be read",
                     "name a video file, or a folder of images");
  }
  state_->start_time = start_time;
  state_->frame_interval = std::chrono::nanoseconds(std::llround(1e9 / rate_hz));
}

VideoFile::~VideoFile() = default;

ReadResult VideoFile::read(Frame& frame) {
  if (!state_->video->read(frame.image)) return {ReadStatus::kEnd, {}};
  state_->position = state_->next_position();
  frame.number = state_->next_number++;
  frame.capture_time = state_->start_time + state_->position;
  return {ReadStatus::kFrame, {}};
}

}  // namespace nadir::vision
