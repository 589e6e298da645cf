#pragma once

#include <Eigen/Core>

#include "vision/pixel.h"

namespace nadir::tracker {

/// The smooth light of a camera's picture, vignette and lamps: the logarithm of the light as a
/// polynomial of order 2 in the pixel, learnt from the slopes of light across discs. A slope that
/// is not known shifts a disc of radius R and blur sigma by about 1.2 R sigma times the relative
/// change of light per pixel: 0.004 px near the corner of a picture with a vignette of 15 %.
class LightShape {
 public:
  LightShape(int width_px, int height_px);

  /// Relative change of the light per pixel.
  Eigen::Vector2d slope_per_px(const vision::PixelPoint& pixel) const;
  /// A slope that was seen, its variance per axis.
  void learn(const vision::PixelPoint& pixel, const Eigen::Vector2d& slope_per_px,
             double variance_per_px2);

 private:
  using Basis = Eigen::Matrix<double, 2, 5>;  ///< d(slope)/d(coefficients)
  Basis basis(const vision::PixelPoint& pixel) const;

  vision::PixelPoint middle_px_;
  double half_px_;
  Eigen::Matrix<double, 5, 5> information_;
  Eigen::Matrix<double, 5, 1> gradient_ = Eigen::Matrix<double, 5, 1>::Zero();
  Eigen::Matrix<double, 5, 1> coefficients_ = Eigen::Matrix<double, 5, 1>::Zero();
  int learnt_ = 0;
};

}  // namespace nadir::tracker
