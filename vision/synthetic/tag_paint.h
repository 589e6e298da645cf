#pragma once

#include <Eigen/Core>

#include "vision/tag_layout.h"
#include "vision/tag_pattern.h"

namespace nadir::vision {

/// A tag on a sprite, in the sprite's own frame.
struct PaintedTag {
  TagMount mount;
  double cell_m = 0.0;
  TagPattern pattern;
  Eigen::Array4f white = Eigen::Array4f::Ones();  ///< blue, green, red reflectance and coverage, 1
  Eigen::Array4f black = Eigen::Array4f::Ones();

  double extent_m() const;  ///< of a circle about the tag's middle
};

/// Lays the tag over samples [begin, end) of a row, whose places in the sprite's frame are x_m,
/// y_m. A sample is as wide as `sample_m` and shows the mean over a square of that size that lies
/// along the tag, which blurs as much as one along the image.
void paint_tag(const PaintedTag& tag, const float* x_m, const float* y_m, int begin, int end,
               float sample_m, Eigen::Array4f* row);

}  // namespace nadir::vision
