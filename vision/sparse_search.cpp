#include "vision/sparse_search.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "vision/vector_clones.h"

namespace nadir::vision {
namespace {

// Steps over the smallest disc's radius: a disc's centre is then at most 0.68 radii from a grid
// point, which lies well inside the edge.
constexpr double kRowStepPerRadius = 1.1;
constexpr double kColumnStepPerRadius = 0.8;
constexpr double kBlur_px = 1.5;
constexpr int kFixedPointShift = 5;
// A grid point must have this much of the wanted hue: grey levels, after sixteenths of its
// brightness.
constexpr std::int16_t kLeastScore = 8;
constexpr int kBrightnessShare = 3;
constexpr int kLeastDifference = 10;  // from its surroundings: more than noise makes
constexpr std::int16_t kNothing = -1000;
// Darkness counts from here down: nothing that is brighter, in grey levels, may be a black disc.
constexpr std::int16_t kBrightestBlack = 96;
constexpr int kCellsAtOnce = 8;
// Neighbours, out of 8, that may have the same hue: another robot's disc, but not a line, which
// goes on in two directions.
constexpr int kMostAlikeNeighbours = 1;
constexpr std::size_t kCacheLineBytes = 64;

int grid_step_px(double step_per_radius, double radius_px) {
  return std::max(1, static_cast<int>(step_per_radius * radius_px));
}

std::array<std::int16_t, 3> fixed_point(const Bgr& coefficients) {
  std::array<std::int16_t, 3> fixed{};
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    fixed[i] = static_cast<std::int16_t>(
        std::lround(coefficients[static_cast<Eigen::Index>(i)] * (1 << kFixedPointShift)));
  }
  return fixed;
}

}  // namespace

SparseSearch::Axis::Axis(int size_px, int step, double surroundings_px)
    : step_px(step),
      first_px(std::min(step / 2, (size_px - 1) / 2)),
      count((size_px - first_px + step - 1) / step),
      margin(static_cast<int>(std::ceil(surroundings_px / step))) {}

SparseSearch::SparseSearch(int width_px, int height_px, double smallest_radius_px,
                           double largest_radius_px, const std::vector<ColourScore>& colours)
    // The surroundings must lie outside the disc from wherever in it the grid point is.
    : u_(width_px, grid_step_px(kColumnStepPerRadius, smallest_radius_px),
         1.68 * largest_radius_px + kBlur_px),
      v_(height_px, grid_step_px(kRowStepPerRadius, smallest_radius_px),
         1.68 * largest_radius_px + kBlur_px),
      stride_(u_.count + 2 * u_.margin),
      plane_size_(static_cast<std::size_t>(stride_) *
                  static_cast<std::size_t>(v_.count + 2 * v_.margin)),
      scores_(plane_size_ * colours.size(), kNothing),
      best_of_row_(static_cast<std::size_t>(v_.count) * colours.size(), kNothing),
      words_(static_cast<std::size_t>(u_.count)),
      blue_(words_.size()),
      green_(words_.size()),
      red_(words_.size()) {
  const auto diagonal = [](int margin) { return std::max(1, (3 * margin + 2) / 4); };
  const int up = stride_ * v_.margin;
  const int up_aslant = stride_ * diagonal(v_.margin);
  const int aside = diagonal(u_.margin);
  surroundings_ = {
      -u_.margin,        u_.margin,        -up, up, -up_aslant - aside, -up_aslant + aside,
      up_aslant - aside, up_aslant + aside};
  for (const ColourScore& colour : colours) {
    colours_.push_back({fixed_point(colour.along), fixed_point(colour.across),
                        fixed_point(colour.second), !colour.second.isZero(),
                        colour.along.sum() < -0.5F ? kBrightestBlack : std::int16_t{0}});
  }
}

void SparseSearch::scan(const cv::Mat& bgr) {
  const std::size_t row_bytes = 3 * static_cast<std::size_t>(bgr.cols);
  for (int row = 0; row < v_.count; ++row) {
    // Rows in between are skipped, which the processor does not foresee: it is told the next one.
    const int next_row = std::min(row + 2, v_.count - 1);
    const std::uint8_t* const next = bgr.ptr<std::uint8_t>(v_.first_px + next_row * v_.step_px);
    for (std::size_t byte = 0; byte < row_bytes; byte += kCacheLineBytes) {
      __builtin_prefetch(next + byte);
    }
    gather_row(bgr.ptr<std::uint8_t>(v_.first_px + row * v_.step_px));
    score_row(row);
  }
}

void SparseSearch::gather_row(const std::uint8_t* row_bgr) {
  const std::uint8_t* pixel = row_bgr + 3 * u_.first_px;
  const int stride_bytes = 3 * u_.step_px;
  const std::size_t last = words_.size() - 1;
  for (std::size_t i = 0; i < last; ++i, pixel += stride_bytes) {
    std::memcpy(&words_[i], pixel, 4);  // the fourth byte belongs to the next pixel
  }
  words_[last] = pixel[0] | pixel[1] << 8 | pixel[2] << 16;
}

NADIR_VECTOR_CLONES
void SparseSearch::score_row(int row) {
  const std::int32_t* __restrict words = words_.data();
  std::int16_t* __restrict b = blue_.data();
  std::int16_t* __restrict g = green_.data();
  std::int16_t* __restrict r = red_.data();
  const int count = u_.count;
  for (int i = 0; i < count; ++i) {
    b[i] = static_cast<std::int16_t>(words[i] & 255);
    g[i] = static_cast<std::int16_t>(words[i] >> 8 & 255);
    r[i] = static_cast<std::int16_t>(words[i] >> 16 & 255);
  }
  // 16-bit throughout: eight or sixteen grid points at once.
  const auto dot = [](const std::array<std::int16_t, 3>& w, std::int16_t x, std::int16_t y,
                      std::int16_t z) {
    return static_cast<std::int16_t>(static_cast<std::int16_t>(w[0] * x + w[1] * y + w[2] * z) >>
                                     kFixedPointShift);
  };
  const auto magnitude = [](std::int16_t x) { return std::max(x, static_cast<std::int16_t>(-x)); };
  for (int colour = 0; colour < static_cast<int>(colours_.size()); ++colour) {
    const FixedPointScore f = colours_[static_cast<std::size_t>(colour)];
    std::int16_t* __restrict out = &scores_[cell_index(colour, row, 0)];
    std::int16_t best = kNothing;
    for (int i = 0; i < count; ++i) {
      const std::int16_t brightest = std::max(std::max(b[i], g[i]), r[i]);
      out[i] = static_cast<std::int16_t>(dot(f.along, b[i], g[i], r[i]) -
                                         magnitude(dot(f.across, b[i], g[i], r[i])) -
                                         (kBrightnessShare * brightest >> 4) + f.offset);
      best = std::max(best, out[i]);
    }
    if (f.has_second) {  // white and black: no hue at all
      for (int i = 0; i < count; ++i) {
        out[i] = static_cast<std::int16_t>(out[i] - magnitude(dot(f.second, b[i], g[i], r[i])));
      }
    }
    best_of_row_[row_index(colour, row)] = best;
  }
}

int SparseSearch::next_seed(int colour, int row, int from) const {
  if (best_of_row_[row_index(colour, row)] < kLeastScore) return u_.count;
  const std::int16_t* const cells = &scores_[cell_index(colour, row, 0)];
  int column = from;
  while (column < u_.count) {
    if (column + kCellsAtOnce <= u_.count) {  // most of the grid has nothing of the hue
      std::int16_t largest = cells[column];
      for (int i = 1; i < kCellsAtOnce; ++i) largest = std::max(largest, cells[column + i]);
      if (largest < kLeastScore) {
        column += kCellsAtOnce;
        continue;
      }
    }
    const int end = std::min(column + kCellsAtOnce, u_.count);
    for (; column < end; ++column) {
      if (cells[column] >= kLeastScore && stands_out(cells + column)) return column;
    }
  }
  return u_.count;
}

bool SparseSearch::stands_out(const std::int16_t* cell) const {
  const int different = std::min(*cell / 2, *cell - kLeastDifference);
  int alike = 0;
  for (const int offset : surroundings_) {
    alike += cell[offset] > different ? 1 : 0;
    if (alike > kMostAlikeNeighbours) return false;
  }
  return true;
}

// Mean of the grid points about one that stands out, weighted with their score: nearer to the
// disc's centre.
PixelPoint SparseSearch::middle_of_neighbours(int colour, int row, int column) const {
  const std::int16_t* const centre = &scores_[cell_index(colour, row, column)];
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
  return {u_.pixel(column + static_cast<double>(sum_column) / sum),
          v_.pixel(row + static_cast<double>(sum_row) / sum)};
}

void SparseSearch::mark(const PixelPoint& centre, double radius_px, int colour) {
  const int row_end =
      std::min(v_.count - 1, static_cast<int>(std::floor(v_.index(centre.y() + radius_px))));
  for (int row = std::max(0, static_cast<int>(std::ceil(v_.index(centre.y() - radius_px))));
       row <= row_end; ++row) {
    const double dv_px = v_.pixel(row) - centre.y();
    const double half_px = std::sqrt(std::max(0.0, radius_px * radius_px - dv_px * dv_px));
    const int begin = std::max(0, static_cast<int>(std::ceil(u_.index(centre.x() - half_px))));
    const int end =
        std::min(u_.count - 1, static_cast<int>(std::floor(u_.index(centre.x() + half_px))));
    for (int column = begin; column <= end; ++column) {
      scores_[cell_index(colour, row, column)] = kNothing;
    }
  }
}

}  // namespace nadir::vision
