#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>

#include "vision/pixel.h"

namespace nadir::vision {

/// Asks memory for the pixels of a square about a place, 2 `reach_px` wide, before they are needed:
/// the processor does not foresee which rows are to come.
inline void fetch_square(const cv::Mat& image, const PixelPoint& centre_px, double reach_px) {
  constexpr std::ptrdiff_t kCacheLineBytes = 64;
  const auto pixel_bytes = static_cast<std::ptrdiff_t>(image.elemSize());
  const std::ptrdiff_t begin = pixel_bytes *
                               std::max(0, static_cast<int>(centre_px.x() - reach_px)) /
                               kCacheLineBytes * kCacheLineBytes;
  const std::ptrdiff_t end =
      pixel_bytes * std::min(image.cols, static_cast<int>(centre_px.x() + reach_px));
  const int row_end = std::min(image.rows, static_cast<int>(centre_px.y() + reach_px));
  for (int row = std::max(0, static_cast<int>(centre_px.y() - reach_px)); row < row_end; ++row) {
    const std::uint8_t* const line = image.ptr<std::uint8_t>(row);
    for (std::ptrdiff_t byte = begin; byte < end; byte += kCacheLineBytes) {
      __builtin_prefetch(line + byte);
    }
  }
}

}  // namespace nadir::vision
