#pragma once

#include <Eigen/Core>

namespace nadir::vision {

/// A place in the image, (u_px, v_px): u to the right, v down; the centre of the top-left pixel is
/// (0, 0).
using PixelPoint = Eigen::Vector2d;

}  // namespace nadir::vision
