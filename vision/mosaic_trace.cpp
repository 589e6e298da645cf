#include "vision/mosaic_trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace nadir::vision {
namespace {

constexpr int kColumns = 12;
constexpr int kRows = 8;
constexpr int kLargest = 32;  // four times grey levels: edges of things count no more than that
constexpr double kMostRatio = 0.5;  // of the two sides of the chess board; 1 without a mosaic

// Four times the difference of a green value from the mean of its four neighbours.
int own_detail(const cv::Mat& bgr, int u, int v) {
  const auto green = [&bgr](int column, int row) -> int {
    return bgr.ptr<std::uint8_t>(row)[3 * column + 1];
  };
  const int around = green(u - 1, v) + green(u + 1, v) + green(u, v - 1) + green(u, v + 1);
  return std::min(kLargest, std::abs(4 * green(u, v) - around));
}

}  // namespace

bool looks_demosaiced(const cv::Mat& bgr) {
  if (bgr.cols < 2 * kColumns || bgr.rows < 2 * kRows) return false;
  std::array<int, 2> detail{};
  for (int row = 0; row < kRows; ++row) {
    const int v = 1 + (bgr.rows - 4) * row / (kRows - 1);
    for (int column = 0; column < kColumns; ++column) {
      const int u = 1 + (bgr.cols - 4) * column / (kColumns - 1);
      detail[(u + v) & 1] += own_detail(bgr, u, v);
      detail[(u + v + 1) & 1] += own_detail(bgr, u + 1, v);
    }
  }
  const auto [less, more] = std::minmax(detail[0], detail[1]);
  // Rounding alone leaves 1 of 4 on average; a frame without noise tells nothing.
  return more > 2 * kColumns * kRows && less < kMostRatio * more;
}

}  // namespace nadir::vision
