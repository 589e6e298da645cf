#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "vision/colour_classes.h"
#include "vision/pixel.h"

namespace nadir::vision {

/// A place where a disc of a wanted colour may be.
struct Seed {
  PixelPoint pixel = PixelPoint::Zero();
  int colour = 0;  ///< index into the list of wanted colours
};

/// Looks at a grid of single pixels, so far apart that every disc of the wanted size covers at
/// least one grid point well inside its edge, and keeps those that have the wanted hue while their
/// surroundings, more than a disc away, have not. Rows between the grid's rows are never read; they
/// lie further apart than the columns, for memory is fetched along rows.
class SparseSearch {
 public:
  /// `smallest_radius_px`, `largest_radius_px`: of the wanted discs in this image.
  SparseSearch(int width_px, int height_px, double smallest_radius_px, double largest_radius_px,
               const std::vector<ColourScore>& colours);

  /// Reads the grid of a CV_8UC3 image of the size given at construction.
  void scan(const cv::Mat& bgr);

  /// Calls visit(seed) for every grid point that may lie in a disc and is not marked.
  template <typename Visit>
  void for_each_seed(Visit&& visit) {
    for (int colour = 0; colour < static_cast<int>(colours_.size()); ++colour) {
      for (int row = 0; row < v_.count; ++row) {
        for (int column = next_seed(colour, row, 0); column < u_.count;
             column = next_seed(colour, row, column + 1)) {
          visit(Seed{middle_of_neighbours(colour, row, column), colour});
        }
      }
    }
  }

  /// Grid points within `radius_px` of `centre` shall not be seeds of this colour any more.
  void mark(const PixelPoint& centre, double radius_px, int colour);

 private:
  /// The grid along one axis of the image.
  struct Axis {
    Axis(int size_px, int step, double surroundings_px);
    double pixel(double index) const { return first_px + step_px * index; }
    double index(double pixel_px) const { return (pixel_px - first_px) / step_px; }

    int step_px;
    int first_px;
    int count;
    int margin;  ///< cells of padding on each side = distance of the surroundings
  };
  struct FixedPointScore {
    std::array<std::int16_t, 3> along;
    std::array<std::int16_t, 3> across;
    std::array<std::int16_t, 3> second;
    bool has_second;
    std::int16_t
        offset;  ///< darkness, black's score, is negative: it needs a grey level to count from
  };

  void gather_row(const std::uint8_t* row_bgr);
  void score_row(int row);
  int next_seed(int colour, int row, int from) const;
  bool stands_out(const std::int16_t* cell) const;
  PixelPoint middle_of_neighbours(int colour, int row, int column) const;
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
  std::vector<std::int32_t> words_;        ///< the present row's grid points
  std::vector<std::int16_t> blue_;
  std::vector<std::int16_t> green_;
  std::vector<std::int16_t> red_;
};

}  // namespace nadir::vision
