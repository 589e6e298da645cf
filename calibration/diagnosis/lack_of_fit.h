#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/pixel_box.h"
#include "vision/pixel.h"

namespace nadir::calibration {

/// What is known at one place of a map's own error, true place minus mapped place.
struct LackOfFitNode {
  Eigen::Vector2d error_m = Eigen::Vector2d::Zero();      ///< expected
  Eigen::Vector2d variance_m2 = Eigen::Vector2d::Zero();  ///< about it, per axis, not below 0
};

/// The systematic error of a map over the image, a value: a grid of nodes over a box of pixels,
/// bilinear between them.
///
/// It is local, because the residuals of a model that does not fit are a smooth function of place:
/// they pass through zero between the middle and the border and are largest in the corners. One
/// number for the whole field is too careful in most places and too bold in the corners.
class LackOfFit {
 public:
  /// No error anywhere.
  LackOfFit() = default;
  /// The same in the whole image: expected 0 with this variance per axis.
  static LackOfFit uniform(double variance_m2);
  /// `nodes` row by row from the low corner; the outer ones lie on the border of the box. Throws
  /// std::invalid_argument: sizes that do not belong together, a number that is not finite, a
  /// negative variance, a box without extent under more than one node.
  LackOfFit(const PixelBox& box, int columns, int rows, std::vector<LackOfFitNode> nodes);

  /// Mean square of the error per axis, error^2 + variance, m^2; outside of the box that of its
  /// nearest place. Four nodes are read; nothing is allocated.
  Eigen::Vector2d mean_square_m2(const vision::PixelPoint& pixel) const;

  const PixelBox& box() const { return box_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  const std::vector<LackOfFitNode>& nodes() const { return nodes_; }

 private:
  PixelBox box_{};
  int columns_ = 1;
  int rows_ = 1;
  std::vector<LackOfFitNode> nodes_ = std::vector<LackOfFitNode>(1);
};

}  // namespace nadir::calibration
