#include "vision/sparse_search.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "vision/vector_clones.h"

namespace nadir::vision {
namespace {

// No place is further from a grid point than the smallest disc's radius less this: well inside the
// blurred edge, also where a JPEG file blurs colours over two pixels. Tiny discs are all edge:
// there a share of the radius serves.
constexpr double kInside_px = 1.8;
constexpr double kInsidePerRadius = 0.55;
// What a grid point costs: as much as so many pixels of its row to be fetched.
constexpr double kPointCost_px = 8.0;
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
constexpr int kBlock = 16;  // grid points that are scored at once
constexpr int kCellsAtOnce = 8;
// Neighbours, out of 8, that may have the same hue: another robot's disc, but not a line, which
// goes on in two directions.
constexpr int kMostAlikeNeighbours = 1;
constexpr std::size_t kCacheLineBytes = 64;
constexpr std::size_t kRowsAhead = 2;
constexpr std::size_t kPointsAtOnce = 16;

std::array<std::int16_t, 3> fixed_point(const Bgr& coefficients) {
  std::array<std::int16_t, 3> fixed{};
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    fixed[i] = static_cast<std::int16_t>(
        std::lround(coefficients[static_cast<Eigen::Index>(i)] * (1 << kFixedPointShift)));
  }
  return fixed;
}

}  // namespace

double SparseSearch::Steps::farthest_px() const { return 0.5 * std::hypot(column_px, row_px); }

// Of all grids that are fine enough the one that costs least per pixel of the image.
SparseSearch::Steps SparseSearch::steps_for(double smallest_radius_px) {
  const double farthest_px =
      std::max(kInsidePerRadius * smallest_radius_px, smallest_radius_px - kInside_px);
  Steps best{1, 1};
  double best_cost = 1.0 + kPointCost_px;
  for (int column_px = 1; column_px < 2.0 * farthest_px; ++column_px) {
    const double half_row_px = std::sqrt(farthest_px * farthest_px - 0.25 * column_px * column_px);
    const int row_px = static_cast<int>(2.0 * half_row_px);
    const double cost = (1.0 + kPointCost_px / column_px) / row_px;
    if (row_px >= 1 && cost < best_cost) {
      best = {column_px, row_px};
      best_cost = cost;
    }
  }
  return best;
}

SparseSearch::Axis::Axis(int size_px, int step, double surroundings_px)
    : step_px(step),
      first_px(std::min(step / 2, (size_px - 1) / 2)),
      count((size_px - first_px + step - 1) / step),
      padded_count((count + kBlock - 1) / kBlock * kBlock),
      margin(static_cast<int>(std::ceil(surroundings_px / step))) {}

SparseSearch::SparseSearch(int width_px, int height_px, double smallest_radius_px,
                           double largest_radius_px, const std::vector<ColourScore>& colours)
    : SparseSearch(width_px, height_px, steps_for(smallest_radius_px), largest_radius_px, colours) {
}

SparseSearch::SparseSearch(int width_px, int height_px, Steps steps, double largest_radius_px,
                           const std::vector<ColourScore>& colours)
    // The surroundings must lie outside the disc from wherever in it the grid point is.
    : u_(width_px, steps.column_px, steps.farthest_px() + largest_radius_px + kBlur_px),
      v_(height_px, steps.row_px, steps.farthest_px() + largest_radius_px + kBlur_px),
      stride_(u_.padded_count + 2 * u_.margin),
      plane_size_(static_cast<std::size_t>(stride_) *
                  static_cast<std::size_t>(v_.count + 2 * v_.margin)),
      scores_(plane_size_ * colours.size(), kNothing),
      best_of_row_(static_cast<std::size_t>(v_.count) * colours.size(), kNothing),
      row_use_(static_cast<std::size_t>(v_.count), RowUse::kSkipped),
      words_(static_cast<std::size_t>(u_.padded_count)),
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
  rows_to_read_.reserve(row_use_.size());
  cells_.reserve(static_cast<std::size_t>(u_.count) * static_cast<std::size_t>(v_.count) *
                 colours.size());
  for (const ColourScore& colour : colours) {
    colours_.push_back({fixed_point(colour.along), fixed_point(colour.across),
                        fixed_point(colour.second), !colour.second.isZero(),
                        colour.along.sum() < -0.5F ? kBrightestBlack : std::int16_t{0}});
  }
}

void SparseSearch::scan(const cv::Mat& bgr) {
  constexpr RowBand kEverything;
  scan(bgr, std::span(&kEverything, 1));
}

void SparseSearch::scan(const cv::Mat& bgr, std::span<const RowBand> bands) {
  choose_rows(bands);
  for (std::size_t i = 0; i < rows_to_read_.size(); ++i) {
    const int row = rows_to_read_[i];
    const int to_come = rows_to_read_[std::min(i + kRowsAhead, rows_to_read_.size() - 1)];
    gather_row(bgr.ptr<std::uint8_t>(v_.first_px + row * v_.step_px),
               bgr.ptr<std::uint8_t>(v_.first_px + to_come * v_.step_px));
    score_row(row);
  }
  for (int colour = 0; colour < static_cast<int>(colours_.size()); ++colour) {
    for (int row = 0; row < v_.count; ++row) {
      if (row_use_[static_cast<std::size_t>(row)] != RowUse::kListed) {
        best_of_row_[row_index(colour, row)] = kNothing;
      }
    }
  }
}

// Rows of the surroundings are read too, so that a seed can be judged, but are not listed.
void SparseSearch::choose_rows(std::span<const RowBand> bands) {
  std::ranges::fill(row_use_, RowUse::kSkipped);
  for (const RowBand& band : bands) {
    const int begin = std::clamp(static_cast<int>(std::ceil(v_.index(band.begin_px))), 0, v_.count);
    const int end = std::clamp(static_cast<int>(std::ceil(v_.index(band.end_px))), begin, v_.count);
    if (begin == end) continue;
    for (int row = std::max(0, begin - v_.margin); row < std::min(v_.count, end + v_.margin);
         ++row) {
      RowUse& use = row_use_[static_cast<std::size_t>(row)];
      use = std::max(use, row >= begin && row < end ? RowUse::kListed : RowUse::kRead);
    }
  }
  rows_to_read_.clear();
  for (int row = 0; row < v_.count; ++row) {
    if (row_use_[static_cast<std::size_t>(row)] != RowUse::kSkipped) rows_to_read_.push_back(row);
  }
}

// Rows in between are skipped, which the processor does not foresee: it is told which one is to
// come.
void SparseSearch::gather_row(const std::uint8_t* row_bgr, const std::uint8_t* row_to_come) {
  const std::size_t stride_bytes = 3 * static_cast<std::size_t>(u_.step_px);
  const std::size_t last = static_cast<std::size_t>(u_.count) - 1;
  std::int32_t* __restrict words = words_.data();
  const std::uint8_t* pixel = row_bgr + 3 * static_cast<std::size_t>(u_.first_px);
  const std::uint8_t* to_come = row_to_come;
  std::size_t i = 0;
  for (; i + kPointsAtOnce <= last; i += kPointsAtOnce) {
    const std::uint8_t* const line_end = to_come + kPointsAtOnce * stride_bytes;
    for (; to_come < line_end; to_come += kCacheLineBytes) __builtin_prefetch(to_come);
    for (std::size_t k = 0; k < kPointsAtOnce; ++k, pixel += stride_bytes) {
      std::memcpy(words + i + k, pixel, 4);  // the fourth byte belongs to the next pixel
    }
  }
  for (; i < last; ++i, pixel += stride_bytes) std::memcpy(words + i, pixel, 4);
  words[last] = pixel[0] | pixel[1] << 8 | pixel[2] << 16;
}

NADIR_VECTOR_CLONES
void SparseSearch::score_row(int row) {
  const std::int32_t* __restrict words = words_.data();
  std::int16_t* __restrict b = blue_.data();
  std::int16_t* __restrict g = green_.data();
  std::int16_t* __restrict r = red_.data();
  // 16-bit throughout, and whole blocks: as many grid points at once as the processor can.
  const int count = u_.padded_count / kBlock * kBlock;
  for (int i = 0; i < count; ++i) {
    b[i] = static_cast<std::int16_t>(words[i] & 255);
    g[i] = static_cast<std::int16_t>(words[i] >> 8 & 255);
    r[i] = static_cast<std::int16_t>(words[i] >> 16 & 255);
  }
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
      const auto share = static_cast<std::int16_t>(kBrightnessShare * brightest);
      out[i] = static_cast<std::int16_t>(dot(f.along, b[i], g[i], r[i]) -
                                         magnitude(dot(f.across, b[i], g[i], r[i])) - (share >> 4) +
                                         f.offset);
      best = std::max(best, out[i]);
    }
    if (f.has_second) {  // white and black: no hue at all
      for (int i = 0; i < u_.count; ++i) {
        out[i] = static_cast<std::int16_t>(out[i] - magnitude(dot(f.second, b[i], g[i], r[i])));
      }
    }
    std::fill(out + u_.count, out + count, kNothing);
    best_of_row_[row_index(colour, row)] = best;
  }
}

void SparseSearch::list_cells() {
  cells_.clear();
  for (int colour = 0; colour < static_cast<int>(colours_.size()); ++colour) {
    for (int row = 0; row < v_.count; ++row) {
      if (best_of_row_[row_index(colour, row)] >= kLeastScore) list_cells_of_row(colour, row);
    }
  }
}

void SparseSearch::list_cells_of_row(int colour, int row) {
  const std::int16_t* const scores = &scores_[cell_index(colour, row, 0)];
  for (int column = 0; column < u_.count;) {
    const int end = std::min(column + kCellsAtOnce, u_.count);
    if (end - column == kCellsAtOnce) {  // most of the grid has nothing of the hue
      std::int16_t largest = scores[column];
      for (int i = 1; i < kCellsAtOnce; ++i) largest = std::max(largest, scores[column + i]);
      if (largest < kLeastScore) {
        column = end;
        continue;
      }
    }
    for (; column < end; ++column) {
      const Cell cell{colour, row, column};
      if (is_seed(cell)) cells_.push_back(cell);
    }
  }
}

bool SparseSearch::is_seed(const Cell& cell) const {
  const std::int16_t* const score = &scores_[cell_index(cell.colour, cell.row, cell.column)];
  return *score >= kLeastScore && stands_out(score);
}

bool SparseSearch::stands_out(const std::int16_t* score) const {
  const int different = std::min(*score / 2, *score - kLeastDifference);
  int alike = 0;
  for (const int offset : surroundings_) {
    alike += score[offset] > different ? 1 : 0;
    if (alike > kMostAlikeNeighbours) return false;
  }
  return true;
}

// Mean of the grid points about one that stands out, weighted with their score: nearer to the
// disc's centre.
PixelPoint SparseSearch::middle_of_neighbours(const Cell& cell) const {
  const std::int16_t* const centre = &scores_[cell_index(cell.colour, cell.row, cell.column)];
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
  return {u_.pixel(cell.column + static_cast<double>(sum_column) / sum),
          v_.pixel(cell.row + static_cast<double>(sum_row) / sum)};
}

// The first cell that lies in something else and is not marked yet.
PixelPoint SparseSearch::place_after(std::vector<Cell>::const_iterator cell) const {
  const auto next = std::find_if(cell, cells_.end(), [&](const Cell& later) {
    const bool same_thing = std::abs(later.row - cell->row) <= v_.margin &&
                            std::abs(later.column - cell->column) <= u_.margin;
    return !same_thing && scores_[cell_index(later.colour, later.row, later.column)] >= kLeastScore;
  });
  const Cell& found = next == cells_.end() ? *cell : *next;
  return {u_.pixel(found.column), v_.pixel(found.row)};
}

void SparseSearch::mark(const PixelPoint& centre, double radius_px, int colour) {
  const int row_end =
      std::min(v_.count - 1, static_cast<int>(std::floor(v_.index(centre.y() + radius_px))));
  for (int row = std::max(0, static_cast<int>(std::ceil(v_.index(centre.y() - radius_px))));
       row <= row_end; ++row) {
    if (row_use_[static_cast<std::size_t>(row)] == RowUse::kSkipped) continue;
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
