#include "vision/sources/v4l2_stream.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>

#include "vision/sources/v4l2_clock.h"
#include "vision/sources/v4l2_negotiation.h"

namespace nadir::vision {
namespace {

constexpr std::uint32_t kBufferCount = 4;

std::runtime_error failure(const std::string& action, int negative_errno) {
  return std::runtime_error(action + ": " + std::strerror(-negative_errno));
}

v4l2_buffer empty_buffer() {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  return buffer;
}

}  // namespace

/// Owns the descriptor.
class V4l2Stream::Device {
 public:
  Device(V4l2System& device_system, const std::string& path)
      : system(device_system), descriptor_(system.open_device(path)) {
    if (descriptor_ < 0) throw failure("cannot be opened", descriptor_);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  ~Device() { system.close_device(descriptor_); }

  int control(std::uint32_t request, void* argument) {
    return system.control(descriptor_, request, argument);
  }
  int descriptor() const { return descriptor_; }

  V4l2System& system;

 private:
  int descriptor_;
};

/// Owns one mapping of the driver's memory.
struct V4l2Stream::Buffer {
  Buffer(Device& device, std::size_t length, std::int64_t offset)
      : system(&device.system), bytes(system->map(device.descriptor(), length, offset), length) {
    if (bytes.data() == nullptr) throw std::runtime_error("its memory cannot be mapped");
  }
  Buffer(Buffer&& other) noexcept : system(other.system), bytes(std::exchange(other.bytes, {})) {}
  Buffer& operator=(Buffer&&) = delete;
  ~Buffer() {
    if (bytes.data() != nullptr) system->unmap(bytes.data(), bytes.size());
  }

  V4l2System* system;
  std::span<const std::uint8_t> bytes;
};

V4l2Stream::V4l2Stream(V4l2System& system, const std::string& device, const V4l2Request& request)
    : device_(std::make_unique<Device>(system, device)) {
  const V4l2Control control = [this](std::uint32_t code, void* argument) {
    return device_->control(code, argument);
  };
  const V4l2Agreement agreement = negotiate(control, request);
  layout_ = agreement.layout;
  frame_interval_ = agreement.frame_interval;
  exposure_ = read_exposure(control);
  map_buffers();
  start();
}

V4l2Stream::~V4l2Stream() {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  device_->control(VIDIOC_STREAMOFF, &type);
}

void V4l2Stream::map_buffers() {
  v4l2_requestbuffers wanted{};
  wanted.count = kBufferCount;
  wanted.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  wanted.memory = V4L2_MEMORY_MMAP;
  if (const int code = device_->control(VIDIOC_REQBUFS, &wanted); code < 0) {
    throw failure("gives no buffers", code);
  }
  if (wanted.count < 2) throw std::runtime_error("gives too few buffers");
  buffers_.reserve(wanted.count);
  for (std::uint32_t index = 0; index < wanted.count; ++index) {
    v4l2_buffer buffer = empty_buffer();
    buffer.index = index;
    if (const int code = device_->control(VIDIOC_QUERYBUF, &buffer); code < 0) {
      throw failure("does not describe its buffers", code);
    }
    buffers_.emplace_back(*device_, buffer.length, buffer.m.offset);
  }
}

void V4l2Stream::start() {
  for (std::uint32_t index = 0; index < buffers_.size(); ++index) {
    v4l2_buffer buffer = empty_buffer();
    buffer.index = index;
    if (const int code = device_->control(VIDIOC_QBUF, &buffer); code < 0) {
      throw failure("does not take its buffers", code);
    }
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (const int code = device_->control(VIDIOC_STREAMON, &type); code < 0) {
    throw failure("does not start", code);
  }
}

V4l2Stream::Wait V4l2Stream::take_newest(std::chrono::milliseconds timeout, V4l2Picture& picture) {
  const int ready = device_->system.wait_readable(device_->descriptor(), timeout);
  if (ready < 0) return Wait::kLost;
  if (ready == 0) return Wait::kNothing;
  std::optional<v4l2_buffer> newest;
  for (std::size_t i = 0; i < buffers_.size(); ++i) {
    v4l2_buffer buffer = empty_buffer();
    const int code = device_->control(VIDIOC_DQBUF, &buffer);
    if (code == -EAGAIN) break;
    if (code < 0 || buffer.index >= buffers_.size()) return Wait::kLost;
    if (newest && device_->control(VIDIOC_QBUF, &*newest) < 0) return Wait::kLost;
    newest = buffer;
  }
  if (!newest) return Wait::kNothing;
  const std::span<const std::uint8_t> memory = buffers_[newest->index].bytes;
  picture.bytes = memory.first(std::min<std::size_t>(newest->bytesused, memory.size()));
  picture.sequence = newest->sequence;
  picture.capture_time = capture_time_of(device_->system, *newest, exposure_);
  picture.is_damaged = (newest->flags & V4L2_BUF_FLAG_ERROR) != 0;
  picture.index = newest->index;
  return Wait::kPicture;
}

bool V4l2Stream::give_back(const V4l2Picture& picture) {
  v4l2_buffer buffer = empty_buffer();
  buffer.index = picture.index;
  return device_->control(VIDIOC_QBUF, &buffer) == 0;
}

}  // namespace nadir::vision
