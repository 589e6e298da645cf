#pragma once

#include <Eigen/Core>
#include <functional>
#include <random>

#include "calibration/field_points.h"

namespace nadir::calibration {

/// The image of all tests here: 1280x960, points on a grid with its border on the border of the
/// image.
inline constexpr double kWidth_px = 1280.0;
inline constexpr double kHeight_px = 960.0;

using Truth = std::function<Eigen::Vector2d(const vision::PixelPoint&)>;

/// A camera looking down (v down, y up) at about 3 mm/px, slightly curved: exactly of second order.
inline Eigen::Vector2d quadratic_truth(const vision::PixelPoint& pixel) {
  const double u = pixel.x() - 640.0;
  const double v = pixel.y() - 480.0;
  return {0.1 + 3.0e-3 * u + 1e-4 * v + 2e-7 * u * u - 1e-7 * u * v + 3e-8 * v * v,
          -0.2 + 5e-5 * u - 3.1e-3 * v - 4e-8 * u * u + 2e-7 * u * v + 1e-7 * v * v};
}

/// A centred lens with radial distortion, cubic in the distance from the middle: order 2 cannot
/// follow it.
inline Eigen::Vector2d barrel_truth(const vision::PixelPoint& pixel) {
  const Eigen::Vector2d from_middle = (pixel - vision::PixelPoint(640.0, 480.0)) / 640.0;
  const Eigen::Vector2d undistorted = from_middle * (1.0 + 0.1 * from_middle.squaredNorm());
  return {2.0 * undistorted.x(), -2.0 * undistorted.y()};
}

/// columns x rows exact points; line numbers as in a file with one header line.
inline FieldPoints grid_points(int columns, int rows, const Truth& truth) {
  FieldPoints points{"points.csv", {}};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const vision::PixelPoint pixel(kWidth_px * column / (columns - 1),
                                     kHeight_px * row / (rows - 1));
      points.points.push_back({pixel, truth(pixel), static_cast<int>(points.points.size()) + 2});
    }
  }
  return points;
}

/// Moves pixels and places by Gaussian noise, one sigma per axis.
inline FieldPoints with_noise(FieldPoints points, double pixel_px, double survey_m,
                              std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  for (FieldPoint& point : points.points) {
    point.pixel += pixel_px * Eigen::Vector2d(normal(random), normal(random));
    point.position_m += survey_m * Eigen::Vector2d(normal(random), normal(random));
  }
  return points;
}

}  // namespace nadir::calibration
