#include "vision/sources/v4l2_pixels.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <array>
#include <exception>
#include <opencv2/imgproc.hpp>

namespace nadir::vision {
namespace {

constexpr int kNoConversion = -1;
constexpr int kCompressed = -2;

struct PixelFormat {
  std::uint32_t fourcc = 0;
  int matrix_type = 0;  ///< of OpenCV, with as many bytes a pixel as the camera's
  int conversion = 0;   ///< OpenCV's code, or one of the constants above
};

// V4L2 names a mosaic by its first four pixels; so do OpenCV's newer aliases.
constexpr std::array kFormats{
    PixelFormat{V4L2_PIX_FMT_BGR24, CV_8UC3, kNoConversion},
    PixelFormat{V4L2_PIX_FMT_RGB24, CV_8UC3, cv::COLOR_RGB2BGR},
    PixelFormat{V4L2_PIX_FMT_SRGGB8, CV_8UC1, cv::COLOR_BayerRGGB2BGR},
    PixelFormat{V4L2_PIX_FMT_SGRBG8, CV_8UC1, cv::COLOR_BayerGRBG2BGR},
    PixelFormat{V4L2_PIX_FMT_SGBRG8, CV_8UC1, cv::COLOR_BayerGBRG2BGR},
    PixelFormat{V4L2_PIX_FMT_SBGGR8, CV_8UC1, cv::COLOR_BayerBGGR2BGR},
    PixelFormat{V4L2_PIX_FMT_YUYV, CV_8UC2, cv::COLOR_YUV2BGR_YUYV},
    PixelFormat{V4L2_PIX_FMT_UYVY, CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
    PixelFormat{V4L2_PIX_FMT_MJPEG, CV_8UC3, kCompressed},
    PixelFormat{V4L2_PIX_FMT_JPEG, CV_8UC3, kCompressed},
    PixelFormat{V4L2_PIX_FMT_GREY, CV_8UC1, cv::COLOR_GRAY2BGR},
};

DecodeStatus convert_raw(std::span<const std::uint8_t> bytes, const V4l2PixelLayout& layout,
                         const PixelFormat& format, cv::Mat& image) {
  const std::size_t row_bytes = static_cast<std::size_t>(layout.width_px) *
                                static_cast<std::size_t>(CV_ELEM_SIZE(format.matrix_type));
  // Some drivers leave the line length empty where lines follow each other without a gap.
  const std::size_t stride = std::max<std::size_t>(row_bytes, layout.bytes_per_line);
  if (layout.width_px < 1 || layout.height_px < 1) return DecodeStatus::kNotAnImage;
  if (bytes.size() < stride * (layout.height_px - 1) + row_bytes) return DecodeStatus::kIncomplete;
  const cv::Mat raw(layout.height_px, layout.width_px, format.matrix_type,
                    const_cast<std::uint8_t*>(bytes.data()), stride);
  if (format.conversion == kNoConversion) {
    raw.copyTo(image);
  } else {
    cv::cvtColor(raw, image, format.conversion);
  }
  return DecodeStatus::kDecoded;
}

}  // namespace

std::span<const std::uint32_t> known_fourccs() {
  static const std::array<std::uint32_t, kFormats.size()> fourccs = [] {
    std::array<std::uint32_t, kFormats.size()> all{};
    std::transform(kFormats.begin(), kFormats.end(), all.begin(),
                   [](const PixelFormat& format) { return format.fourcc; });
    return all;
  }();
  return fourccs;
}

std::string fourcc_text(std::uint32_t fourcc) {
  std::string text;
  for (int shift = 0; shift < 32; shift += 8) text += static_cast<char>((fourcc >> shift) & 0x7F);
  return text;
}

DecodeStatus convert_picture(std::span<const std::uint8_t> bytes, const V4l2PixelLayout& layout,
                             cv::Mat& image) {
  const auto format =
      std::find_if(kFormats.begin(), kFormats.end(),
                   [&layout](const PixelFormat& known) { return known.fourcc == layout.fourcc; });
  if (format == kFormats.end()) return DecodeStatus::kNotAnImage;
  if (format->conversion == kCompressed) return decode_image(bytes, image);
  try {
    return convert_raw(bytes, layout, *format, image);
  } catch (const std::exception&) {
    return DecodeStatus::kNotAnImage;
  }
}

}  // namespace nadir::vision
