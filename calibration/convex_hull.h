#pragma once

#include <vector>

#include "vision/pixel.h"

namespace nadir::calibration {

/// The smallest convex polygon around pixels, a value. Empty: nothing is known, and every pixel
/// counts as inside.
class ConvexHull {
 public:
  ConvexHull() = default;
  /// Of any number of pixels, by Andrew's monotone chain.
  static ConvexHull of(std::vector<vision::PixelPoint> pixels);
  /// `vertices` as vertices() gives them. Throws std::invalid_argument where they are not finite or
  /// do not turn the same way at every corner.
  explicit ConvexHull(std::vector<vision::PixelPoint> vertices);

  /// Counter-clockwise where u points right and v up; without points on the edges.
  const std::vector<vision::PixelPoint>& vertices() const { return vertices_; }
  bool is_empty() const { return vertices_.empty(); }
  /// Inside or on the border.
  bool holds(const vision::PixelPoint& pixel) const;
  /// The nearest place of the polygon; the pixel itself where that is inside.
  vision::PixelPoint nearest(const vision::PixelPoint& pixel) const;
  double area_px2() const;

 private:
  std::vector<vision::PixelPoint> vertices_;
};

}  // namespace nadir::calibration
