#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace nadir::vision {

/// The system calls that a camera needs, so that tests can unplug one. Failures are negative errno
/// values.
class V4l2System {
 public:
  V4l2System() = default;
  V4l2System(const V4l2System&) = delete;
  V4l2System& operator=(const V4l2System&) = delete;
  virtual ~V4l2System() = default;

  /// A descriptor that does not block, or a negative errno value.
  virtual int open_device(const std::string& path) = 0;
  virtual void close_device(int descriptor) = 0;
  /// ioctl: 0, or a negative errno value.
  virtual int control(int descriptor, std::uint32_t request, void* argument) = 0;
  /// Maps a driver's buffer for reading; null where that fails.
  virtual const std::uint8_t* map(int descriptor, std::size_t length, std::int64_t offset) = 0;
  virtual void unmap(const std::uint8_t* memory, std::size_t length) = 0;
  /// 1 if a picture waits, 0 after the time-out, a negative errno value if the device is lost.
  virtual int wait_readable(int descriptor, std::chrono::milliseconds timeout) = 0;

  virtual std::chrono::nanoseconds monotonic_now() = 0;  ///< CLOCK_MONOTONIC, the drivers' clock
  virtual std::chrono::nanoseconds unix_now() = 0;       ///< since the Unix epoch
  virtual void sleep(std::chrono::nanoseconds duration) = 0;
};

/// The system calls themselves.
V4l2System& kernel_v4l2();

}  // namespace nadir::vision
