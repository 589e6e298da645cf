#include "vision/sources/video_file.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <fstream>
#include <opencv2/videoio.hpp>
#include <opencv2/videoio/registry.hpp>

#include "vision/input/input_error.h"

namespace nadir::vision {
namespace {

/// False where the file is no video. OpenCV's exceptions end here. The other back ends are asked
/// only where FFmpeg is absent: they complain on stderr, each in its own words, about what is no
/// video.
bool open_quietly(cv::VideoCapture& video, const std::filesystem::path& file) {
  try {
    const bool has_ffmpeg = cv::videoio_registry::hasBackend(cv::CAP_FFMPEG);
    return video.open(file.string(), has_ffmpeg ? cv::CAP_FFMPEG : cv::CAP_ANY);
  } catch (const std::exception&) {
    return false;
  }
}

bool read_quietly(cv::VideoCapture& video, cv::Mat& image) {
  try {
    return video.read(image) && !image.empty() && image.type() == CV_8UC3;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

struct VideoFile::State {
  cv::VideoCapture video;
  CaptureTime start_time;
  std::chrono::nanoseconds frame_interval;
  std::chrono::nanoseconds position{-1};  ///< of the last frame, from the start of the file
  std::uint64_t next_number = 0;

  std::chrono::nanoseconds next_position() const {
    const double from_container_ms = video.get(cv::CAP_PROP_POS_MSEC);
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
  if (!open_quietly(state_->video, file)) {
    throw InputError({file.string()}, "is not a video that can be read",
                     "name a video file, or a folder of images");
  }
  state_->start_time = start_time;
  state_->frame_interval = std::chrono::nanoseconds(std::llround(1e9 / rate_hz));
}

VideoFile::~VideoFile() = default;

ReadResult VideoFile::read(Frame& frame) {
  if (!read_quietly(state_->video, frame.image)) return {ReadStatus::kEnd, {}};
  state_->position = state_->next_position();
  frame.number = state_->next_number++;
  frame.capture_time = state_->start_time + state_->position;
  return {ReadStatus::kFrame, {}};
}

}  // namespace nadir::vision
