#pragma once

#include <Eigen/Core>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tests/calibration/synthetic_points.h"

namespace nadir::calibration {

/// Grey level of a place of the field, 0 to 255.
using Shade = std::function<double(const Eigen::Vector2d& place_m)>;

/// The field through a camera whose pixels show the places of `truth`: rays x rays of them a pixel,
/// then blur of 0.7 px and Gaussian noise of 3 grey levels. Few rays make edges rough, by a few
/// hundredths of a pixel. CV_8UC3.
cv::Mat drawn_picture(const cv::Size& size, const Truth& truth, const Shade& shade,
                      std::uint64_t seed, int rays = 4);

/// A checkerboard of `columns` x `rows` inner corners with its corner (0, 0) at `origin_m` and its
/// columns in this direction, rows a quarter turn to the left of it; black where the sum of both
/// indices is even. Grey around it.
Shade checkerboard(const Eigen::Vector2d& origin_m, double direction_rad, double square_m,
                   int columns, int rows);

/// A tag of family 36h11 on the field: side of its black border, its right hand along +x.
struct DrawnTag {
  int id = 0;
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
};
Shade tags(const std::vector<DrawnTag>& placed, double side_m);

/// Pixel of a place by Newton's method on `truth`.
vision::PixelPoint pixel_of(const Truth& truth, const Eigen::Vector2d& place_m,
                            const vision::PixelPoint& start);

void write_png(const std::string& file, const cv::Mat& picture);

}  // namespace nadir::calibration
