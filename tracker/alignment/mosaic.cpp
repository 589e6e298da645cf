#include "tracker/alignment/mosaic.h"

#include <algorithm>
#include <cstdlib>

namespace nadir::tracker {
namespace {

constexpr int kColumns = 24;
constexpr int kRows = 16;
constexpr int kBlock = 4;             // pixels on a side that are looked at in one place
constexpr int kLargest = 32;          // four times grey levels: edges count no more than that
constexpr double kLeastDetail = 1.0;  // mean of a colour's noisiest phase; rounding alone has less
constexpr double kLeastRatio = 1.5;   // native over interpolated detail; about 3 in truth

using Details = std::array<std::array<double, 4>, 3>;  // [channel][2 (v & 1) + (u & 1)]

// Four times the difference of a value from the mean of its neighbours up, down, left and right:
// sums over the blocks, for each channel and phase.
Details details_of(const cv::Mat& bgr) {
  Details sums{};
  const auto value = [&bgr](int u, int v, int channel) -> int {
    return bgr.ptr<std::uint8_t>(v)[3 * u + channel];
  };
  for (int row = 0; row < kRows; ++row) {
    const int first_v = 1 + (bgr.rows - kBlock - 2) * row / (kRows - 1);
    for (int column = 0; column < kColumns; ++column) {
      const int first_u = 1 + (bgr.cols - kBlock - 2) * column / (kColumns - 1);
      for (int v = first_v; v < first_v + kBlock; ++v) {
        for (int u = first_u; u < first_u + kBlock; ++u) {
          for (int c = 0; c < 3; ++c) {
            const int around =
                value(u - 1, v, c) + value(u + 1, v, c) + value(u, v - 1, c) + value(u, v + 1, c);
            const int phase = 2 * (v & 1) + (u & 1);
            sums[static_cast<std::size_t>(c)][static_cast<std::size_t>(phase)] +=
                std::min(kLargest, std::abs(4 * value(u, v, c) - around));
          }
        }
      }
    }
  }
  return sums;
}

// Detail where the mosaic has measured over detail elsewhere, means over the colours.
double contrast_of(const Details& details, Mosaic mosaic) {
  const std::array<int, 4> native = native_channels(mosaic);
  double measured = 0.0;
  double interpolated = 0.0;
  for (std::size_t phase = 0; phase < 4; ++phase) {
    for (std::size_t c = 0; c < 3; ++c) {
      // Green has two native phases, the others one: each colour counts the same.
      const bool is_native = native[phase] == static_cast<int>(c);
      const double share = c == 1 ? 2.0 : (is_native ? 1.0 : 3.0);
      (is_native ? measured : interpolated) += details[c][phase] / share;
    }
  }
  return measured / std::max(1.0, interpolated);
}

}  // namespace

const std::vector<std::string> kMosaicNames = {"none", "rggb", "bggr", "grbg", "gbrg", "auto"};

std::optional<Mosaic> mosaic_from_name(const std::string& name) {
  const auto index = std::ranges::find(kMosaicNames, name) - kMosaicNames.begin();
  if (index >= 5) return std::nullopt;
  return static_cast<Mosaic>(index);
}

const std::string& mosaic_name(std::optional<Mosaic> mosaic) {
  return mosaic ? kMosaicNames[static_cast<std::size_t>(*mosaic)] : kMosaicNames.back();
}

std::array<int, 4> native_channels(Mosaic mosaic) {
  switch (mosaic) {
    case Mosaic::kRggb:
      return {2, 1, 1, 0};
    case Mosaic::kBggr:
      return {0, 1, 1, 2};
    case Mosaic::kGrbg:
      return {1, 2, 0, 1};
    case Mosaic::kGbrg:
      return {1, 0, 2, 1};
    case Mosaic::kNone:
      break;
  }
  return {0, 0, 0, 0};
}

Mosaic recognise_mosaic(const cv::Mat& bgr) {
  if (bgr.type() != CV_8UC3 || bgr.cols < 2 * kBlock * kColumns || bgr.rows < 2 * kBlock * kRows) {
    return Mosaic::kNone;
  }
  const Details details = details_of(bgr);
  const double counted = kColumns * kRows * kBlock * kBlock / 4.0;  // pixels of a phase
  if (*std::ranges::max_element(details[1]) < kLeastDetail * counted) return Mosaic::kNone;
  Mosaic best = Mosaic::kNone;
  double best_contrast = kLeastRatio;
  for (const Mosaic mosaic : {Mosaic::kRggb, Mosaic::kBggr, Mosaic::kGrbg, Mosaic::kGbrg}) {
    const double contrast = contrast_of(details, mosaic);
    if (contrast <= best_contrast) continue;
    best = mosaic;
    best_contrast = contrast;
  }
  return best;
}

}  // namespace nadir::tracker
