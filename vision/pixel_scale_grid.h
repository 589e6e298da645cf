#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "vision/pixel.h"

namespace nadir::vision {

/// How many metres of the marker plane a pixel shows, and in which direction, at each place of the
/// image: all that a detector must know about a calibration. Whoever has the calibration makes one.
class PixelScaleGrid {
 public:
  /// d(x_m, y_m)/d(u_px, v_px) at a pixel.
  using JacobianFunction = std::function<Eigen::Matrix2d(const PixelPoint&)>;

  /// Samples `jacobian` at nodes `spacing_px` apart (last ones at or beyond the border). It is not
  /// called later.
  PixelScaleGrid(int width_px, int height_px, const JacobianFunction& jacobian,
                 int spacing_px = 32);

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }
  /// Bilinear between the nodes; places outside the image take the nearest border.
  Eigen::Matrix2d metres_per_pixel(const PixelPoint& pixel) const;
  /// Its inverse, d(u_px, v_px)/d(x_m, y_m).
  Eigen::Matrix2d pixels_per_metre(const PixelPoint& pixel) const;
  /// Smallest and largest sqrt|det d(u,v)/d(x,y)| of all nodes, pixels per metre.
  double smallest_pixels_per_metre() const { return smallest_pixels_per_metre_; }
  double largest_pixels_per_metre() const { return largest_pixels_per_metre_; }

 private:
  int width_px_;
  int height_px_;
  int spacing_px_;
  int columns_;
  int rows_;
  std::vector<Eigen::Matrix2d> nodes_;
  double smallest_pixels_per_metre_ = 0.0;
  double largest_pixels_per_metre_ = 0.0;
};

}  // namespace nadir::vision
