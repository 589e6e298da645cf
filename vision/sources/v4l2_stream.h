#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vision/frame.h"
#include "vision/sources/v4l2_pixels.h"
#include "vision/sources/v4l2_system.h"

namespace nadir::vision {

/// What is asked of a camera. It may answer otherwise; its answer counts.
struct V4l2Request {
  int width_px = 0;   ///< 0: as it stands
  int height_px = 0;  ///< 0: as it stands
  double rate_hz = 30.0;
};

/// A picture in the driver's memory, until it is given back.
struct V4l2Picture {
  std::span<const std::uint8_t> bytes;
  std::uint32_t sequence = 0;  ///< the driver's frame count
  CaptureTime capture_time;    ///< middle of the exposure
  bool is_damaged = false;     ///< the driver says so
  std::uint32_t index = 0;     ///< for give_back
};

/// A camera that delivers: opened, format agreed, buffers mapped, streaming. Ends all of it when it
/// is destroyed.
class V4l2Stream {
 public:
  enum class Wait { kPicture, kNothing, kLost };

  /// Throws std::runtime_error with one line that says what the camera refused.
  V4l2Stream(V4l2System& system, const std::string& device, const V4l2Request& request);
  ~V4l2Stream();
  V4l2Stream(const V4l2Stream&) = delete;
  V4l2Stream& operator=(const V4l2Stream&) = delete;

  /// Waits for pictures and takes the newest; older ones that wait too go back unseen, so that a
  /// slow reader does not fall behind. After kPicture, give_back must follow.
  Wait take_newest(std::chrono::milliseconds timeout, V4l2Picture& picture);
  /// False if the device is lost.
  bool give_back(const V4l2Picture& picture);

  const V4l2PixelLayout& layout() const { return layout_; }
  /// From picture to picture, as the camera promises.
  std::chrono::nanoseconds frame_interval() const { return frame_interval_; }

 private:
  class Device;
  struct Buffer;

  void map_buffers();
  void start();

  std::unique_ptr<Device> device_;
  V4l2PixelLayout layout_;
  std::chrono::nanoseconds frame_interval_{0};
  std::chrono::nanoseconds exposure_{0};
  std::vector<Buffer> buffers_;
};

}  // namespace nadir::vision
