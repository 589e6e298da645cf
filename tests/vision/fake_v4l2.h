#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "vision/sources/v4l2_system.h"

namespace nadir::vision {

/// A camera in memory that tests plug, unplug and feed. It keeps account of what is opened, mapped
/// and queued as a kernel would, and its clocks move only when somebody waits or a test says so.
class FakeV4l2 final : public V4l2System {
 public:
  struct Format {
    std::uint32_t fourcc = 0;
    double best_rate_hz = 30.0;
  };
  struct Picture {
    std::vector<std::uint8_t> bytes;
    std::uint32_t sequence = 0;
    std::chrono::nanoseconds stamp{0};  ///< monotonic
    std::uint32_t flags = 0;
  };

  // The camera.
  bool is_plugged = true;
  bool is_readable = true;  ///< false: poll reports the loss
  std::vector<Format> formats;
  std::uint32_t width_px = 4;
  std::uint32_t height_px = 2;
  bool has_free_size = true;            ///< false: it always answers with its own size
  std::uint32_t abilities = 0;          ///< set by the constructor
  int exposure_100us = 0;               ///< 0: no such control
  std::map<std::uint32_t, int> refuse;  ///< request: errno with which it fails
  std::deque<Picture> pictures;         ///< that the camera will deliver

  // What happened.
  int opened = 0;
  int open_descriptors = 0;
  int open_mappings = 0;
  std::vector<std::chrono::nanoseconds> open_times;
  std::uint32_t chosen_fourcc = 0;
  bool is_streaming = false;
  std::deque<std::uint32_t> queued_buffers;

  std::chrono::nanoseconds monotonic{std::chrono::seconds(100)};
  std::chrono::nanoseconds unix_minus_monotonic{std::chrono::seconds(1'700'000'000)};

  FakeV4l2();

  int open_device(const std::string& path) override;
  void close_device(int descriptor) override;
  int control(int descriptor, std::uint32_t request, void* argument) override;
  const std::uint8_t* map(int descriptor, std::size_t length, std::int64_t offset) override;
  void unmap(const std::uint8_t* memory, std::size_t length) override;
  int wait_readable(int descriptor, std::chrono::milliseconds timeout) override;
  std::chrono::nanoseconds monotonic_now() override { return monotonic; }
  std::chrono::nanoseconds unix_now() override { return monotonic + unix_minus_monotonic; }
  void sleep(std::chrono::nanoseconds duration) override { monotonic += duration; }

 private:
  int describe_format(void* argument) const;
  int set_format(void* argument);
  int set_rate(void* argument) const;
  int dequeue(void* argument);

  std::vector<std::vector<std::uint8_t>> memory_;
};

}  // namespace nadir::vision
