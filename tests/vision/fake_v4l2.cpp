#include "tests/vision/fake_v4l2.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>

namespace nadir::vision {
namespace {

constexpr std::size_t kBufferBytes = 4096;

template <typename Argument>
Argument& as(void* argument) {
  return *static_cast<Argument*>(argument);
}

}  // namespace

FakeV4l2::FakeV4l2()
    : formats{{V4L2_PIX_FMT_GREY}}, abilities(V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING) {}

int FakeV4l2::open_device(const std::string& /*path*/) {
  open_times.push_back(monotonic);
  if (!is_plugged) return -ENOENT;
  ++opened;
  ++open_descriptors;
  return 7;
}

void FakeV4l2::close_device(int /*descriptor*/) {
  --open_descriptors;
  is_streaming = false;
  queued_buffers.clear();
}

int FakeV4l2::control(int /*descriptor*/, std::uint32_t request, void* argument) {
  if (!is_plugged) return -ENODEV;
  if (const auto refused = refuse.find(request); refused != refuse.end()) return -refused->second;
  switch (request) {
    case VIDIOC_QUERYCAP:
      as<v4l2_capability>(argument).capabilities = abilities;
      return 0;
    case VIDIOC_ENUM_FMT:
      return describe_format(argument);
    case VIDIOC_G_FMT:
      as<v4l2_format>(argument).fmt.pix = {};
      as<v4l2_format>(argument).fmt.pix.width = width_px;
      as<v4l2_format>(argument).fmt.pix.height = height_px;
      return 0;
    case VIDIOC_S_FMT:
      return set_format(argument);
    case VIDIOC_S_PARM:
      return set_rate(argument);
    case VIDIOC_G_CTRL:
      if (exposure_100us == 0) return -EINVAL;
      as<v4l2_control>(argument).value = exposure_100us;
      return 0;
    case VIDIOC_REQBUFS:
      memory_.assign(as<v4l2_requestbuffers>(argument).count,
                     std::vector<std::uint8_t>(kBufferBytes));
      return 0;
    case VIDIOC_QUERYBUF:
      as<v4l2_buffer>(argument).length = kBufferBytes;
      as<v4l2_buffer>(argument).m.offset =
          static_cast<std::uint32_t>(as<v4l2_buffer>(argument).index * kBufferBytes);
      return 0;
    case VIDIOC_QBUF:
      queued_buffers.push_back(as<v4l2_buffer>(argument).index);
      return 0;
    case VIDIOC_STREAMON:
      is_streaming = true;
      return 0;
    case VIDIOC_STREAMOFF:
      is_streaming = false;
      return 0;
    case VIDIOC_DQBUF:
      return dequeue(argument);
    default:
      return -ENOTTY;
  }
}

int FakeV4l2::describe_format(void* argument) const {
  auto& description = as<v4l2_fmtdesc>(argument);
  if (description.index >= formats.size()) return -EINVAL;
  description.pixelformat = formats[description.index].fourcc;
  return 0;
}

int FakeV4l2::set_format(void* argument) {
  v4l2_pix_format& pixels = as<v4l2_format>(argument).fmt.pix;
  chosen_fourcc = pixels.pixelformat;
  if (!has_free_size) {
    pixels.width = width_px;
    pixels.height = height_px;
  }
  return 0;
}

int FakeV4l2::set_rate(void* argument) const {
  v4l2_fract& interval = as<v4l2_streamparm>(argument).parm.capture.timeperframe;
  const auto format = std::find_if(formats.begin(), formats.end(), [this](const Format& one) {
    return one.fourcc == chosen_fourcc;
  });
  const double wish_hz = static_cast<double>(interval.denominator) / interval.numerator;
  interval.numerator = 1000;
  interval.denominator =
      static_cast<std::uint32_t>(1000.0 * std::min(wish_hz, format->best_rate_hz));
  return 0;
}

int FakeV4l2::dequeue(void* argument) {
  if (pictures.empty() || queued_buffers.empty() || !is_streaming) return -EAGAIN;
  auto& buffer = as<v4l2_buffer>(argument);
  const Picture picture = pictures.front();
  pictures.pop_front();
  buffer.index = queued_buffers.front();
  queued_buffers.pop_front();
  std::copy(picture.bytes.begin(), picture.bytes.end(), memory_[buffer.index].begin());
  buffer.bytesused = static_cast<std::uint32_t>(picture.bytes.size());
  buffer.sequence = picture.sequence;
  buffer.flags = picture.flags;
  buffer.timestamp.tv_sec = picture.stamp.count() / 1'000'000'000;
  buffer.timestamp.tv_usec = picture.stamp.count() % 1'000'000'000 / 1000;
  return 0;
}

const std::uint8_t* FakeV4l2::map(int /*descriptor*/, std::size_t /*length*/, std::int64_t offset) {
  ++open_mappings;
  return memory_[static_cast<std::size_t>(offset) / kBufferBytes].data();
}

void FakeV4l2::unmap(const std::uint8_t* /*memory*/, std::size_t /*length*/) { --open_mappings; }

int FakeV4l2::wait_readable(int /*descriptor*/, std::chrono::milliseconds timeout) {
  if (!is_plugged || !is_readable) return -ENODEV;
  if (!pictures.empty()) return 1;
  monotonic += timeout;
  return 0;
}

}  // namespace nadir::vision
