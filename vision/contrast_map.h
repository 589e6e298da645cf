#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace nadir::vision {

/// Where a frame has strong contrast at all, from single pixels on a grid: tags are nowhere else.
/// Keeps its memory.
class ContrastMap {
 public:
  /// `spacing_px` between the pixels that are looked at, one in spacing^2. Tiles have four by four
  /// of them.
  ContrastMap(int width_px, int height_px, int spacing_px);

  int tile_px() const { return 4 * spacing_px_; }
  int rows() const { return rows_; }  ///< of tiles

  /// Looks at tile rows [first, last) of a CV_8UC3 (its green) or CV_8UC1 frame.
  void look(const cv::Mat& image, int first, int last);
  /// Contrast of the brightest few tiles among those of the last look: the 99.9th percentile or so.
  int strongest() const;
  /// Tiles that touch this part of the image say nothing until they are looked at again.
  void blank(const cv::Rect& part);
  /// Boxes around connected tiles of the last look whose contrast is `least` or more. The reference
  /// is valid until the next call.
  const std::vector<cv::Rect>& patches(int least);

 private:
  void flood(int row, int column, int least, cv::Rect& box);

  int spacing_px_;
  int columns_;
  int rows_;
  int first_ = 0;
  int last_ = 0;
  std::vector<std::uint8_t> contrast_;
  std::vector<int> open_;
  std::vector<cv::Rect> patches_;
};

}  // namespace nadir::vision
