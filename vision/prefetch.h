#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>

#include "vision/pixel.h"

namespace nadir::vision {

inline constexpr std::ptrdiff_t kCacheLineBytes = 64;

/// Asks memory for bytes that are needed soon.
inline void fetch(const void* from, std::ptrdiff_t bytes) {
  const auto* const first = static_cast<const std::uint8_t*>(from);
  for (std::ptrdiff_t byte = 0; byte < bytes; byte += kCacheLineBytes) {
    __builtin_prefetch(first + byte);
  }
  __builtin_prefetch(first + bytes - 1);
}

/// The pixels of a square of an image that memory is asked for before they are needed, row by row:
/// the processor does not foresee which rows are to come, and stands still when it is asked for
/// more than it can wait for at once. Between other work a row costs almost nothing. The image must
/// outlive it.
class SquareFetch {
 public:
  SquareFetch() = default;  ///< nothing to fetch
  /// The square about `centre_px`, 2 `reach_px` wide, as far as it lies in the image.
  SquareFetch(const cv::Mat& image, const PixelPoint& centre_px, double reach_px) {
    const auto pixel_bytes = static_cast<std::ptrdiff_t>(image.elemSize());
    const auto left = std::max(0, static_cast<int>(centre_px.x() - reach_px));
    const auto right = std::min(image.cols, static_cast<int>(centre_px.x() + reach_px));
    const auto top = std::max(0, static_cast<int>(centre_px.y() - reach_px));
    const auto bottom = std::min(image.rows, static_cast<int>(centre_px.y() + reach_px));
    if (right <= left || bottom <= top) return;
    const std::ptrdiff_t begin = pixel_bytes * left / kCacheLineBytes * kCacheLineBytes;
    row_ = image.ptr<std::uint8_t>(top) + begin;
    row_bytes_ = pixel_bytes * right - begin;
    step_bytes_ = static_cast<std::ptrdiff_t>(image.step[0]);
    rows_left_ = bottom - top;
  }

  void next_row() {
    if (rows_left_ <= 0) return;
    for (std::ptrdiff_t byte = 0; byte < row_bytes_; byte += kCacheLineBytes) {
      __builtin_prefetch(row_ + byte);
    }
    --rows_left_;
    if (rows_left_ > 0) row_ += step_bytes_;
  }
  void all_rows() {
    while (rows_left_ > 0) next_row();
  }
  bool is_done() const { return rows_left_ <= 0; }

 private:
  const std::uint8_t* row_ = nullptr;
  std::ptrdiff_t row_bytes_ = 0;
  std::ptrdiff_t step_bytes_ = 0;
  int rows_left_ = 0;
};

/// Several squares, one after the other.
class PixelFetch {
 public:
  static constexpr std::size_t kMostSquares = 8;

  PixelFetch() = default;  ///< nothing to fetch
  /// A ninth square is not fetched ahead.
  void add(const SquareFetch& square) {
    if (count_ < kMostSquares && !square.is_done()) squares_[count_++] = square;
  }
  void next_row() {
    if (now_ == count_) return;
    squares_[now_].next_row();
    if (squares_[now_].is_done()) ++now_;
  }
  void all_rows() {
    while (now_ < count_) next_row();
  }

 private:
  std::array<SquareFetch, kMostSquares> squares_;
  std::size_t count_ = 0;
  std::size_t now_ = 0;
};

}  // namespace nadir::vision
