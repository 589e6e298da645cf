#include "vision/synthetic/local_plane_map.h"

#include <Eigen/LU>

namespace nadir::vision {
namespace {

using Matrix5 = Eigen::Matrix<double, 5, 5>;

// Chebyshev nodes: the error is spread evenly over the rectangle.
constexpr double kNodes[5] = {-0.95105651629515357, -0.58778525229247314, 0.0, 0.58778525229247314,
                              0.95105651629515357};

/// Turns values at the nodes into coefficients of powers.
Matrix5 coefficients_from_nodes() {
  Matrix5 powers;
  for (int i = 0; i < 5; ++i) {
    double power = 1.0;
    for (int j = 0; j < 5; ++j, power *= kNodes[i]) powers(i, j) = power;
  }
  return powers.inverse();
}

}  // namespace

LocalPlaneMap::LocalPlaneMap(const CameraModel& camera, double plane_height_m,
                             const PixelPoint& low_px, const PixelPoint& high_px)
    : centre_px_(0.5 * (low_px + high_px)), half_px_(0.5 * (high_px - low_px)) {
  static const Matrix5 from_nodes = coefficients_from_nodes();
  Matrix5 values[2];
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      const PixelPoint pixel =
          centre_px_ + PixelPoint(kNodes[i] * half_px_.x(), kNodes[j] * half_px_.y());
      const Eigen::Vector2d place = camera.on_plane(pixel, plane_height_m);
      values[0](i, j) = place.x();
      values[1](i, j) = place.y();
    }
  }
  for (int k = 0; k < 2; ++k) coefficients_[k] = from_nodes * values[k] * from_nodes.transpose();
}

LocalPlaneMap::RowPolynomial LocalPlaneMap::row(double v_px) const {
  const double s = (v_px - centre_px_.y()) / half_px_.y();
  Eigen::Matrix<double, 5, 1> powers;
  powers << 1.0, s, s * s, s * s * s, s * s * s * s;
  RowPolynomial row;
  row.row(0) = (coefficients_[0] * powers).transpose();
  row.row(1) = (coefficients_[1] * powers).transpose();
  return row;
}

}  // namespace nadir::vision
