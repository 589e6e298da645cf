#pragma once

#include <Eigen/Core>

#include "vision/pixel.h"
#include "vision/pixel_scale_grid.h"

namespace nadir::vision {

/// The marker plane around one place of the image, as an affine map.
struct LocalScale {
  Eigen::Matrix2f pixels_per_metre;  ///< d(u_px, v_px)/d(x_m, y_m)
  Eigen::Matrix2f metres_per_pixel;  ///< its inverse
  float scale_px_per_m = 0.0F;       ///< sqrt|det|: a disc of radius r covers pi (r scale)^2 pixels
};

LocalScale local_scale(const PixelScaleGrid& grid, const PixelPoint& pixel);

}  // namespace nadir::vision
