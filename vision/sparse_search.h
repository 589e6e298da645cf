#pragma once

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
/// surroundings, more than a disc away, have not. Rows between the grid's rows are never read.
class SparseSearch {
 public:
  /// `disc_radius_px`: smallest and largest radius of the wanted discs in this image.
  SparseSearch(int width_px, int height_px, double smallest_radius_px, double largest_radius_px,
               const std::vector<ColourScore>& colours);

  /// Reads the grid of a CV_8UC3 image of the size given at construction.
  void scan(const cv::Mat& bgr);

  /// Calls visit(seed) for every grid point that may lie in a disc and is not marked.
  template <typename Visit>
  void for_each_seed(Visit&& visit) {
    for (int colour = 0; colour < static_cast<int>(colours_.size()); ++colour) {
      for (int row = 0; row < rows_; ++row) {
        for (int column = next_seed(colour, row, 0); column < columns_;
             column = next_seed(colour, row, column + 1)) {
          visit(Seed{middle_of_neighbours(colour, row, column), colour});
        }
      }
    }
  }

  /// Grid points within `radius_px` of `centre` shall not be seeds of this colour any more.
  void mark(const PixelPoint& centre, double radius_px, int colour);

  int step_px() const { return step_px_; }

 private:
  struct FixedPointScore {
    std::int16_t along[3];
    std::int16_t across[3];
    std::int16_t second[3];
  };

  void score_row(const std::uint8_t* row_bgr, int row);
  int next_seed(int colour, int row, int from) const;
  bool stands_out(const std::int16_t* cell) const;
  PixelPoint middle_of_neighbours(int colour, int row, int column) const;
  std::int16_t* cell(int colour, int row, int column) {
    return &scores_[static_cast<std::size_t>(colour) * plane_size_ +
                    static_cast<std::size_t>(row + margin_) * stride_ + column + margin_];
  }
  const std::int16_t* cell(int colour, int row, int column) const {
    return const_cast<SparseSearch*>(this)->cell(colour, row, column);
  }

  int step_px_;
  int first_px_;
  int columns_;
  int rows_;
  int margin_;  ///< cells of padding on each side = distance of the surroundings
  int stride_;
  std::size_t plane_size_;
  std::vector<FixedPointScore> colours_;
  std::vector<std::int16_t> scores_;  ///< one padded plane per colour
  std::vector<std::int16_t> blue_, green_, red_;
};

}  // namespace nadir::vision
