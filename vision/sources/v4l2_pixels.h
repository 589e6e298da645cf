#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <string>

#include "vision/sources/image_decoder.h"

namespace nadir::vision {

/// How a camera lays its pictures out in memory.
struct V4l2PixelLayout {
  std::uint32_t fourcc = 0;  ///< V4L2_PIX_FMT_...
  int width_px = 0;
  int height_px = 0;
  int bytes_per_line = 0;  ///< 0 for compressed pictures
};

/// The layouts that can be converted, best first: full colour, then the sensor's own mosaic, then
/// halved colour, then compressed, then grey.
std::span<const std::uint32_t> known_fourccs();

/// "YUYV"
std::string fourcc_text(std::uint32_t fourcc);

/// Converts one picture to CV_8UC3, blue green red; into the image's own buffer where its size fits
/// and the picture is not compressed. Too few bytes give kIncomplete. Never throws.
DecodeStatus convert_picture(std::span<const std::uint8_t> bytes, const V4l2PixelLayout& layout,
                             cv::Mat& image);

}  // namespace nadir::vision
