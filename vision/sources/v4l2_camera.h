#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "vision/frame_source.h"
#include "vision/sources/v4l2_stream.h"

namespace nadir::vision {

/// A camera behind Video4Linux that may come and go: while it is away, read() says so and opens it
/// again, first after 100 ms, then at growing intervals up to 1 s, for ever.
///
/// Capture times are the driver's (see capture_time_of). Frame numbers follow the driver's count,
/// so that pictures that were lost, or skipped because the reader was slow, leave a gap; after a
/// reconnection they go on.
class V4l2Camera final : public FrameSource {
 public:
  /// @param device  such as /dev/video0; it need not exist yet
  /// @param system  must live longer than the camera
  V4l2Camera(std::string device, const V4l2Request& request, V4l2System& system = kernel_v4l2());
  ~V4l2Camera() override;

  ReadResult read(Frame& frame) override;
  bool is_live() const override { return true; }

 private:
  ReadResult unavailable(const std::string& problem) const;
  /// False while the camera is away; problem_ says why.
  bool open_when_due();
  ReadResult wait_for_picture(Frame& frame);
  ReadResult convert(const V4l2Picture& picture, Frame& frame);
  /// Closes the camera and plans the next try.
  void lose(const std::string& problem);
  std::uint64_t number_of(std::uint32_t sequence);

  std::string device_;
  V4l2Request request_;
  V4l2System& system_;
  std::unique_ptr<V4l2Stream> stream_;  ///< null while the camera is away

  std::string problem_;                   ///< why it is away
  std::chrono::nanoseconds next_try_{0};  ///< monotonic clock
  std::chrono::nanoseconds back_off_{0};
  std::chrono::nanoseconds last_sign_of_life_{0};  ///< monotonic clock

  std::uint64_t next_number_ = 0;
  std::uint32_t last_sequence_ = 0;
  bool has_sequence_ = false;  ///< since the camera was opened
};

}  // namespace nadir::vision
