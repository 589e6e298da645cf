#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "vision/pixel.h"

namespace nadir::calibration {

/// The inner corners of a checkerboard: where four squares meet.
struct BoardSize {
  int columns = 0;  ///< corners along one side, 3 to 100
  int rows = 0;     ///< corners along the other
};

/// Corners of a board in the image, `columns` x `rows` of them.
struct BoardCorners {
  BoardSize size;
  /// Row by row. Which corner is the first is not said: a board looks the same from two ends.
  std::vector<vision::PixelPoint> corners;

  const vision::PixelPoint& at(int column, int row) const {
    return corners[static_cast<std::size_t>(row) * static_cast<std::size_t>(size.columns) +
                   static_cast<std::size_t>(column)];
  }
};

/// Finds the whole board in a picture (CV_8UC3 or CV_8UC1), nothing where a corner of it is hidden
/// or the squares are under about 8 px.
///
/// A corner is a saddle of the brightness: candidates are the maxima of I_uv^2 - I_uu I_vv on the
/// blurred image whose ring changes between dark and bright four times; each is moved to where the
/// gradients around it are perpendicular to the way there (Foerstner's operator). The board grows
/// from corner to corner by what the neighbours' distances promise, so that a lens may bend it.
std::optional<BoardCorners> find_checkerboard(const cv::Mat& picture, const BoardSize& size);

}  // namespace nadir::calibration
