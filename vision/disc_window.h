#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "vision/colour_classes.h"
#include "vision/pixel.h"

namespace nadir::vision {

/// Shares below `low` count nothing, above `high` fully, between them in proportion.
struct ShareLimits {
  float low;
  float high;
};

/// Where a disc is looked for, and what its pixels look like. A pixel's share in the disc is a
/// linear function of its value: 0 in the surroundings, 1 in the disc.
struct DiscWindow {
  PixelPoint centre = PixelPoint::Zero();
  float radius_px = 0.0F;
  /// Pixel offset -> offset in which the disc is a circle of radius_px; determinant 1 or -1.
  Eigen::Matrix2f to_round;
  Bgr surroundings = Bgr::Zero();
  Bgr difference = Bgr::Zero();  ///< of the disc's colour from its surroundings, not zero
  Bgr share_of = Bgr::Zero();    ///< share = share_of . (value - surroundings); of difference: 1
  ShareLimits limits{0.0F, 1.0F};
  int row_step = 1;      ///< 2: every second row, ... are enough for a first approach
  float slope_u = 0.0F;  ///< of the light across the disc, relative change per pixel
  float slope_v = 0.0F;
};

/// Sums over a window's pixels, weighted with their limited shares. Offsets count from the window's
/// centre, in pixels.
struct WeightSums {
  float weight = 0.0F;
  float weight_u = 0.0F;
  float weight_v = 0.0F;
  /// Sum of squared distances of the pixels whose share is between the limits: those on the edge,
  /// through which noise moves the centre.
  float edge_moment_px2 = 0.0F;
};

/// One pass over the pixels within the disc's radius and about one more, eight at a time. Pixels
/// that are neither disc nor surroundings nor a mixture of both (a line, another robot's disc)
/// count nothing.
WeightSums sum_weights(const cv::Mat& bgr, const DiscWindow& window);

/// Shares of the pixels well inside a disc: how many, how bright, how the light runs across them.
struct InsideShares {
  int count = 0;
  float mean = 0.0F;
  float slope_u = 0.0F;  ///< share per pixel, least squares
  float slope_v = 0.0F;
  float explained = 0.0F;  ///< sum of squares that the slopes explain
  float scatter = 0.0F;    ///< variance about the slopes, without bias
};

InsideShares inside_shares(const cv::Mat& bgr, const DiscWindow& window);

}  // namespace nadir::vision
