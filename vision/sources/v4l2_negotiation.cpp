#include "vision/sources/v4l2_negotiation.h"

#include <linux/videodev2.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>
#include <set>
#include <stdexcept>

#include "vision/sources/v4l2_stream.h"

namespace nadir::vision {
namespace {

using std::chrono::nanoseconds;

constexpr double kEnoughOfRate = 0.9;

void require_camera(const V4l2Control& control) {
  v4l2_capability capability{};
  if (control(VIDIOC_QUERYCAP, &capability) < 0) throw std::runtime_error("is no video device");
  const std::uint32_t abilities = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0
                                      ? capability.device_caps
                                      : capability.capabilities;
  if ((abilities & V4L2_CAP_VIDEO_CAPTURE) == 0) {
    throw std::runtime_error("is a video device that takes no pictures");
  }
  if ((abilities & V4L2_CAP_STREAMING) == 0) {
    throw std::runtime_error("is a camera that cannot stream");
  }
}

std::set<std::uint32_t> offered_fourccs(const V4l2Control& control) {
  std::set<std::uint32_t> fourccs;
  for (std::uint32_t index = 0;; ++index) {
    v4l2_fmtdesc description{};
    description.index = index;
    description.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (control(VIDIOC_ENUM_FMT, &description) < 0) return fourccs;
    fourccs.insert(description.pixelformat);
  }
}

/// Seconds a frame as the camera answers; the wish itself where it does not know rates.
nanoseconds ask_interval(const V4l2Control& control, double rate_hz) {
  const nanoseconds wish(std::llround(1e9 / rate_hz));
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  parameters.parm.capture.timeperframe.numerator = 1000;
  parameters.parm.capture.timeperframe.denominator =
      static_cast<std::uint32_t>(std::llround(1000.0 * rate_hz));
  if (control(VIDIOC_S_PARM, &parameters) < 0) return wish;
  const v4l2_fract answer = parameters.parm.capture.timeperframe;
  if (answer.numerator == 0 || answer.denominator == 0) return wish;
  return nanoseconds(std::llround(1e9 * answer.numerator / answer.denominator));
}

/// Sets one format; nothing if the camera refuses it or answers with another one.
std::optional<V4l2Agreement> try_format(const V4l2Control& control, std::uint32_t fourcc,
                                        const V4l2Request& request) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (control(VIDIOC_G_FMT, &format) < 0) return std::nullopt;
  v4l2_pix_format& pixels = format.fmt.pix;
  if (request.width_px > 0) pixels.width = static_cast<std::uint32_t>(request.width_px);
  if (request.height_px > 0) pixels.height = static_cast<std::uint32_t>(request.height_px);
  pixels.pixelformat = fourcc;
  pixels.field = V4L2_FIELD_NONE;
  pixels.bytesperline = 0;  // this and the next are the driver's to fill
  pixels.sizeimage = 0;
  if (control(VIDIOC_S_FMT, &format) < 0 || pixels.pixelformat != fourcc) return std::nullopt;
  V4l2Agreement agreement;
  agreement.layout = {fourcc, static_cast<int>(pixels.width), static_cast<int>(pixels.height),
                      static_cast<int>(pixels.bytesperline)};
  agreement.frame_interval = ask_interval(control, request.rate_hz);
  return agreement;
}

bool satisfies(const V4l2Agreement& agreement, const V4l2Request& request) {
  const V4l2PixelLayout& layout = agreement.layout;
  const double rate_hz = 1e9 / static_cast<double>(agreement.frame_interval.count());
  return (request.width_px <= 0 || layout.width_px == request.width_px) &&
         (request.height_px <= 0 || layout.height_px == request.height_px) &&
         rate_hz >= kEnoughOfRate * request.rate_hz;
}

}  // namespace

V4l2Agreement negotiate(const V4l2Control& control, const V4l2Request& request) {
  require_camera(control);
  const std::set<std::uint32_t> offered = offered_fourccs(control);
  std::optional<std::uint32_t> second_best;
  for (const std::uint32_t fourcc : known_fourccs()) {
    if (!offered.contains(fourcc)) continue;
    const auto agreement = try_format(control, fourcc, request);
    if (!agreement) continue;
    if (satisfies(*agreement, request)) return *agreement;
    if (!second_best) second_best = fourcc;
  }
  if (second_best) {
    if (const auto agreement = try_format(control, *second_best, request)) return *agreement;
  }
  std::string names;
  for (const std::uint32_t fourcc : offered) {
    names += (names.empty() ? "" : ", ") + fourcc_text(fourcc);
  }
  throw std::runtime_error("offers no usable format (it has " +
                           (names.empty() ? std::string("none") : names) + ")");
}

std::chrono::nanoseconds read_exposure(const V4l2Control& control) {
  v4l2_control exposure{};
  exposure.id = V4L2_CID_EXPOSURE_ABSOLUTE;
  if (control(VIDIOC_G_CTRL, &exposure) < 0 || exposure.value <= 0) return nanoseconds(0);
  return exposure.value * std::chrono::microseconds(100);  // the control's unit
}

}  // namespace nadir::vision
