#include "vision/sparse_search.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace nadir::vision {
namespace {

// Grid step over disc radius: the nearest grid point is then at most 0.57 radii from a disc's
// centre.
constexpr double kStepPerRadius = 0.8;
constexpr int kFixedPointShift = 5;
// A grid point must have this much of the wanted hue: grey levels, and share of its brightness (1 /
// 8).
constexpr std::int16_t kLeastScore = 8;
constexpr int kBrightnessShift = 3;
constexpr std::int16_t kNothing = -1000;
// Neighbours, out of 8, that may have the same hue (another robot's disc, a line).
constexpr int kMostAlikeNeighbours = 2;

std::int16_t fixed_point(float coefficient) {
  return static_cast<std::int16_t>(std::lround(coefficient * (1 << kFixedPointShift)));
}

}  // namespace

SparseSearch::SparseSearch(int width_px, int height_px, double smallest_radius_px,
                           double largest_radius_px, const std::vector<ColourScore>& colours)
    : step_px_(std::max(1, static_cast<int>(std::lround(kStepPerRadius * smallest_radius_px)))),
      first_px_(step_px_ / 2),
      columns_((width_px - first_px_ + step_px_ - 1) / step_px_),
      rows_((height_px - first_px_ + step_px_ - 1) / step_px_),
      // The surroundings must lie outside the disc from wherever in it the grid point is, blur
      // included.
      margin_(
          static_cast<int>(std::ceil((largest_radius_px + step_px_ * M_SQRT1_2 + 1.5) / step_px_))),
      stride_(columns_ + 2 * margin_),
      plane_size_(static_cast<std::size_t>(stride_) * (rows_ + 2 * margin_)),
      scores_(plane_size_ * colours.size(), kNothing),
      blue_(columns_),
      green_(columns_),
      red_(columns_) {
  for (const ColourScore& colour : colours) {
    FixedPointScore fixed{};
    for (int channel = 0; channel < 3; ++channel) {
      fixed.along[channel] = fixed_point(colour.along[channel]);
      fixed.across[channel] = fixed_point(colour.across[channel]);
      fixed.second[channel] = fixed_point(colour.second[channel]);
    }
    colours_.push_back(fixed);
  }
}

void SparseSearch::scan(const cv::Mat& bgr) {
  for (int row = 0; row < rows_; ++row) {
    score_row(bgr.ptr<std::uint8_t>(first_px_ + row * step_px_), row);
  }
}

void SparseSearch::score_row(const std::uint8_t* row_bgr, int row) {
  const std::uint8_t* pixel = row_bgr + 3 * first_px_;
  const int stride_bytes = 3 * step_px_;
  for (int i = 0; i < columns_; ++i, pixel += stride_bytes) {
    blue_[i] = pixel[0];
    green_[i] = pixel[1];
    red_[i] = pixel[2];
  }
  const std::int16_t* const b = blue_.data();
  const std::int16_t* const g = green_.data();
  const std::int16_t* const r = red_.data();
  for (std::size_t colour = 0; colour < colours_.size(); ++colour) {
    const FixedPointScore f = colours_[colour];
    std::int16_t* const out = cell(static_cast<int>(colour), row, 0);
    const auto dot = [](const std::int16_t* w, std::int16_t x, std::int16_t y, std::int16_t z) {
      return static_cast<std::int16_t>(static_cast<std::int16_t>(w[0] * x + w[1] * y + w[2] * z) >>
                                       kFixedPointShift);
    };
    for (int i = 0; i < columns_; ++i) {  // 16-bit throughout: eight or sixteen grid points at once
      const std::int16_t along = dot(f.along, b[i], g[i], r[i]);
      const std::int16_t across = dot(f.across, b[i], g[i], r[i]);
      const std::int16_t second = dot(f.second, b[i], g[i], r[i]);
      const std::int16_t brightest = std::max(std::max(b[i], g[i]), r[i]);
      const auto magnitude = [](std::int16_t x) {
        return std::max(x, static_cast<std::int16_t>(-x));
      };
      out[i] = static_cast<std::int16_t>(along - magnitude(across) - magnitude(second) -
                                         (brightest >> kBrightnessShift));
    }
  }
}

int SparseSearch::next_seed(int colour, int row, int from) const {
  const std::int16_t* const cells = cell(colour, row, 0);
  int column = from;
  while (column < columns_) {
    // Most of the grid has nothing of the hue: skip eight points at a time.
    if (column + 8 <= columns_) {
      std::int16_t largest = cells[column];
      for (int i = 1; i < 8; ++i) largest = std::max(largest, cells[column + i]);
      if (largest < kLeastScore) {
        column += 8;
        continue;
      }
    }
    const int end = std::min(column + 8, columns_);
    for (; column < end; ++column) {
      if (cells[column] >= kLeastScore && stands_out(cells + column)) return column;
    }
  }
  return columns_;
}

bool SparseSearch::stands_out(const std::int16_t* centre) const {
  const int near = margin_;
  const int diagonal = std::max(1, static_cast<int>(std::lround(margin_ * 0.75)));
  const int offsets[8] = {-near,
                          near,
                          -near * stride_,
                          near * stride_,
                          -diagonal * (stride_ + 1),
                          diagonal * (stride_ + 1),
                          -diagonal * (stride_ - 1),
                          diagonal * (stride_ - 1)};
  const int half = *centre / 2;
  int alike = 0;
  for (const int offset : offsets) {
    alike += centre[offset] > half ? 1 : 0;
    if (alike > kMostAlikeNeighbours) return false;
  }
  return true;
}

// Mean of the grid points about one that stands out, weighted with their score: nearer to the
// disc's centre.
PixelPoint SparseSearch::middle_of_neighbours(int colour, int row, int column) const {
  const std::int16_t* const centre = cell(colour, row, column);
  int sum = 0;
  int sum_column = 0;
  int sum_row = 0;
  for (int dr = -1; dr <= 1; ++dr) {
    for (int dc = -1; dc <= 1; ++dc) {
      const int weight = std::max<int>(0, centre[dr * stride_ + dc]);
      sum += weight;
      sum_column += weight * dc;
      sum_row += weight * dr;
    }
  }
  return {first_px_ + step_px_ * (column + static_cast<double>(sum_column) / sum),
          first_px_ + step_px_ * (row + static_cast<double>(sum_row) / sum)};
}

void SparseSearch::mark(const PixelPoint& centre, double radius_px, int colour) {
  const auto grid = [this](double pixel) { return (pixel - first_px_) / step_px_; };
  const int row_end =
      std::min(rows_ - 1, static_cast<int>(std::floor(grid(centre.y() + radius_px))));
  for (int row = std::max(0, static_cast<int>(std::ceil(grid(centre.y() - radius_px))));
       row <= row_end; ++row) {
    const double dy_px = first_px_ + row * step_px_ - centre.y();
    const double half_px = std::sqrt(std::max(0.0, radius_px * radius_px - dy_px * dy_px));
    const int end =
        std::min(columns_ - 1, static_cast<int>(std::floor(grid(centre.x() + half_px))));
    for (int column = std::max(0, static_cast<int>(std::ceil(grid(centre.x() - half_px))));
         column <= end; ++column) {
      *cell(colour, row, column) = kNothing;
    }
  }
}

}  // namespace nadir::vision
