#include "vision/pixel_scale_grid.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace nadir::vision {
namespace {

/// Nodes from 0 in steps of `spacing_px` so that the last one is at or beyond the last pixel; two
/// at least, so that every place lies between two nodes.
int node_count(int size_px, int spacing_px) {
  return std::max(2, 1 + (size_px - 1 + spacing_px - 1) / spacing_px);
}

}  // namespace

PixelScaleGrid::PixelScaleGrid(int width_px, int height_px, const JacobianFunction& jacobian,
                               int spacing_px)
    : width_px_(width_px), height_px_(height_px), spacing_px_(spacing_px), columns_(0), rows_(0) {
  if (width_px < 1 || height_px < 1 || spacing_px < 1) {
    throw std::invalid_argument("PixelScaleGrid: sizes must be positive");
  }
  columns_ = node_count(width_px, spacing_px);
  rows_ = node_count(height_px, spacing_px);
  nodes_.reserve(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  smallest_pixels_per_metre_ = std::numeric_limits<double>::infinity();
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      nodes_.push_back(jacobian(PixelPoint(column * spacing_px, row * spacing_px)));
      const double pixels_per_metre = 1.0 / std::sqrt(std::abs(nodes_.back().determinant()));
      smallest_pixels_per_metre_ = std::min(smallest_pixels_per_metre_, pixels_per_metre);
      largest_pixels_per_metre_ = std::max(largest_pixels_per_metre_, pixels_per_metre);
    }
  }
}

Eigen::Matrix2d PixelScaleGrid::metres_per_pixel(const PixelPoint& pixel) const {
  const double column = std::clamp(pixel.x(), 0.0, width_px_ - 1.0) / spacing_px_;
  const double row = std::clamp(pixel.y(), 0.0, height_px_ - 1.0) / spacing_px_;
  const int left = std::min(static_cast<int>(column), columns_ - 2);
  const int top = std::min(static_cast<int>(row), rows_ - 2);
  const double right_share = column - left;
  const double bottom_share = row - top;
  const Eigen::Matrix2d* const upper = &nodes_[static_cast<std::size_t>(top) * columns_ + left];
  const Eigen::Matrix2d* const lower = upper + columns_;
  return (1.0 - bottom_share) * ((1.0 - right_share) * upper[0] + right_share * upper[1]) +
         bottom_share * ((1.0 - right_share) * lower[0] + right_share * lower[1]);
}

Eigen::Matrix2d PixelScaleGrid::pixels_per_metre(const PixelPoint& pixel) const {
  return metres_per_pixel(pixel).inverse();
}

}  // namespace nadir::vision
