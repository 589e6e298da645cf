#pragma once

#include "vision/pixel.h"

namespace nadir::calibration {

/// An upright rectangle in the image, pixels.
struct PixelBox {
  vision::PixelPoint low_px = vision::PixelPoint::Zero();
  vision::PixelPoint high_px = vision::PixelPoint::Zero();

  /// The nearest place of the box.
  vision::PixelPoint nearest(const vision::PixelPoint& pixel) const {
    return pixel.cwiseMax(low_px).cwiseMin(high_px);
  }
  bool holds(const vision::PixelPoint& pixel) const { return nearest(pixel) == pixel; }
};

}  // namespace nadir::calibration
