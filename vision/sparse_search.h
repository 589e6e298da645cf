#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "vision/colour_classes.h"
#include "vision/pixel.h"

namespace nadir::vision {

/// Rows of an image, the last not included.
struct RowBand {
  int begin_px = 0;
  int end_px = 1 << 30;
};

/// A place where a disc of a wanted colour may be.
struct Seed {
  PixelPoint pixel = PixelPoint::Zero();
  int colour = 0;  ///< index into the list of wanted colours
};

/// Looks at a grid of single pixels, so far apart that every disc of the wanted size covers at
/// least one grid point inside its blurred edge, and keeps those that have the wanted hue while
/// their surroundings, more than a disc away, have not. Rows between the grid's rows are never
/// read; they lie further apart than the columns, for memory is fetched along rows.
class SparseSearch {
 public:
  /// `smallest_radius_px`, `largest_radius_px`: of the wanted discs in this image.
  SparseSearch(int width_px, int height_px, double smallest_radius_px, double largest_radius_px,
               const std::vector<ColourScore>& colours);

  /// Reads the grid of a CV_8UC3 image of the size given at construction.
  void scan(const cv::Mat& bgr);
  /// Only some rows of the image, in any order: other places are no seeds.
  void scan(const cv::Mat& bgr, std::span<const RowBand> bands);

  /// Calls visit(seed, next) for every grid point that may lie in a disc and is not marked. `next`
  /// is about where the next thing will be looked at: time to have its pixels fetched.
  template <typename Visit>
  void for_each_seed(Visit&& visit) {
    list_cells();
    for (auto cell = cells_.begin(); cell != cells_.end(); ++cell) {
      if (!is_seed(*cell)) continue;
      visit(Seed{middle_of_neighbours(*cell), cell->colour}, place_after(cell));
    }
  }

  /// Grid points within `radius_px` of `centre` shall not be seeds of this colour any more.
  void mark(const PixelPoint& centre, double radius_px, int colour);

 private:
  struct Steps {
    int column_px;
    int row_px;
    double farthest_px() const;  ///< of any place from its nearest grid point
  };
  /// The grid along one axis of the image.
  struct Axis {
    Axis(int size_px, int step, double surroundings_px);
    double pixel(double index) const { return first_px + step_px * index; }
    double index(double pixel_px) const { return (pixel_px - first_px) / step_px; }

    int step_px;
    int first_px;
    int count;
    int padded_count;  ///< to whole blocks of grid points that are scored at once
    int margin;        ///< cells of padding on each side = distance of the surroundings
  };
  /// What becomes of a row: its cells may be seeds, or are the surroundings of such cells.
  enum class RowUse : std::uint8_t { kSkipped, kRead, kListed };
  struct Cell {
    int colour;
    int row;
    int column;
  };
  struct FixedPointScore {
    std::array<std::int16_t, 3> along;
    std::array<std::int16_t, 3> across;
    std::array<std::int16_t, 3> second;
    bool has_second;
    std::int16_t
        offset;  ///< darkness, black's score, is negative: it needs a grey level to count from
  };

  static Steps steps_for(double smallest_radius_px);
  SparseSearch(int width_px, int height_px, Steps steps, double largest_radius_px,
               const std::vector<ColourScore>& colours);
  void choose_rows(std::span<const RowBand> bands);
  void gather_row(const std::uint8_t* row_bgr, const std::uint8_t* row_to_come);
  void score_row(int row);
  void list_cells();
  void list_cells_of_row(int colour, int row);
  bool is_seed(const Cell& cell) const;
  bool stands_out(const std::int16_t* score) const;
  PixelPoint middle_of_neighbours(const Cell& cell) const;
  PixelPoint place_after(std::vector<Cell>::const_iterator cell) const;
  std::size_t cell_index(int colour, int row, int column) const {
    return static_cast<std::size_t>(colour) * plane_size_ +
           static_cast<std::size_t>(row + v_.margin) * static_cast<std::size_t>(stride_) +
           static_cast<std::size_t>(column + u_.margin);
  }
  std::size_t row_index(int colour, int row) const {
    return static_cast<std::size_t>(colour) * static_cast<std::size_t>(v_.count) +
           static_cast<std::size_t>(row);
  }

  Axis u_;
  Axis v_;
  int stride_;
  std::size_t plane_size_;
  std::array<int, 8> surroundings_;  ///< offsets of a cell's neighbours more than a disc away
  std::vector<FixedPointScore> colours_;
  std::vector<std::int16_t> scores_;       ///< one padded plane per colour
  std::vector<std::int16_t> best_of_row_;  ///< largest score of each row of each plane
  std::vector<RowUse> row_use_;
  std::vector<int> rows_to_read_;
  std::vector<Cell> cells_;          ///< that may lie in a disc, row by row
  std::vector<std::int32_t> words_;  ///< the present row's grid points
  std::vector<std::int16_t> blue_;
  std::vector<std::int16_t> green_;
  std::vector<std::int16_t> red_;
};

}  // namespace nadir::vision
