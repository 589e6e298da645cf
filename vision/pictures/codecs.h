#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace nadir::vision {

/// A video file that is being read.
class VideoReader {
 public:
  virtual ~VideoReader() = default;
  /// The next picture, CV_8UC3; false at the end and where the file is damaged. Never throws.
  virtual bool read(cv::Mat& bgr) = 0;
  /// Of the last picture in the container, milliseconds; 0 or not finite where it tells none.
  virtual double position_ms() const = 0;
};

/// OpenCV's readers and writers of pictures and videos. They come with two hundred libraries (of
/// maps, films and devices), which take a fifth of a second to load: as long as ten frames of a
/// robot that drives blind. So they are a library of their own, loaded when they are first asked
/// for; a tracker that shows no picture starts without them.
class Codecs {
 public:
  virtual ~Codecs() = default;
  /// CV_8UC3; empty where the bytes (CV_8UC1, one row) are no picture. May throw cv::Exception.
  virtual cv::Mat decode(const cv::Mat& bytes) const = 0;
  /// False where the file cannot be written. Throws cv::Exception for an ending that is not known.
  /// `parameters`: OpenCV's, in pairs (cv::ImwriteFlags).
  virtual bool write(const std::string& file, const cv::Mat& picture,
                     const std::vector<int>& parameters = {}) const = 0;
  /// Null where the file is no video. Never throws.
  virtual std::unique_ptr<VideoReader> open_video(const std::string& file) const = 0;
};

/// Loads them at the first call. Throws std::runtime_error if the library is not where it was
/// installed. Thread-safe.
const Codecs& codecs();

/// Call it where the first picture must not wait for that.
inline void load_codecs() { codecs(); }

}  // namespace nadir::vision
