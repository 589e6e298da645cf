#include "vision/local_scale.h"

#include <Eigen/LU>
#include <cmath>

namespace nadir::vision {

LocalScale local_scale(const PixelScaleGrid& grid, const PixelPoint& pixel) {
  LocalScale scale;
  scale.metres_per_pixel = grid.metres_per_pixel(pixel).cast<float>();
  scale.pixels_per_metre = scale.metres_per_pixel.inverse();
  scale.scale_px_per_m = std::sqrt(std::abs(scale.pixels_per_metre.determinant()));
  return scale;
}

}  // namespace nadir::vision
