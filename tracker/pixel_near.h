#pragma once

#include <Eigen/LU>

#include "calibration/plane_map.h"
#include "vision/pixel.h"

namespace nadir::tracker {

/// Where the image shows a place that is a robot's width at most from what `near_px` shows: two
/// Newton steps, as the map is all but linear over a robot. Exact to far below 0.01 px.
inline vision::PixelPoint pixel_near(const calibration::PlaneMap& map,
                                     const Eigen::Vector2d& place_m,
                                     const vision::PixelPoint& near_px) {
  vision::PixelPoint pixel = near_px;
  for (int step = 0; step < 2; ++step) {
    const Eigen::Vector2d missing_m = place_m - map.plane_from_pixel(pixel);
    pixel += map.jacobian_m_per_px(pixel).inverse() * missing_m;
  }
  return pixel;
}

}  // namespace nadir::tracker
