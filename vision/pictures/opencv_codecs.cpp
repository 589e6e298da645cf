// The library that is loaded when pictures or videos are first asked for.
#include <exception>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <opencv2/videoio/registry.hpp>

#include "vision/pictures/codecs.h"

namespace nadir::vision {
namespace {

class OpenCvVideo final : public VideoReader {
 public:
  /// The other back ends are asked only where FFmpeg is absent: they complain on stderr, each in
  /// its own words, about what is no video.
  bool open(const std::string& file) {
    try {
      const bool has_ffmpeg = cv::videoio_registry::hasBackend(cv::CAP_FFMPEG);
      return video_.open(file, has_ffmpeg ? cv::CAP_FFMPEG : cv::CAP_ANY);
    } catch (const std::exception&) {
      return false;
    }
  }

  bool read(cv::Mat& bgr) override {
    try {
      return video_.read(bgr) && !bgr.empty() && bgr.type() == CV_8UC3;
    } catch (const std::exception&) {
      return false;
    }
  }

  double position_ms() const override { return video_.get(cv::CAP_PROP_POS_MSEC); }

 private:
  cv::VideoCapture video_;
};

class OpenCvCodecs final : public Codecs {
 public:
  cv::Mat decode(const cv::Mat& bytes) const override {
    return cv::imdecode(bytes, cv::IMREAD_COLOR);
  }
  bool write(const std::string& file, const cv::Mat& picture,
             const std::vector<int>& parameters) const override {
    return cv::imwrite(file, picture, parameters);
  }
  std::unique_ptr<VideoReader> open_video(const std::string& file) const override {
    auto video = std::make_unique<OpenCvVideo>();
    if (!video->open(file)) return nullptr;
    return video;
  }
};

}  // namespace
}  // namespace nadir::vision

extern "C" const nadir::vision::Codecs* nadir_codecs() {
  static const nadir::vision::OpenCvCodecs codecs;
  return &codecs;
}
