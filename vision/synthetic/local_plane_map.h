#pragma once

#include <Eigen/Core>

#include "vision/synthetic/camera_model.h"

namespace nadir::vision {

/// The inverse of a camera on a plane over a small rectangle of the image, as a polynomial of order
/// 4 in u and in v through 25 exact points: cheap to evaluate along a row. Within 1e-3 px of the
/// exact map over rectangles of 64 px even in the corners of a strongly distorting lens; the error
/// grows with the fifth power of the size.
class LocalPlaneMap {
 public:
  /// Coefficients of t^0 to t^4 of the plane's x and y along one image row.
  using RowPolynomial = Eigen::Matrix<double, 2, 5>;

  LocalPlaneMap(const CameraModel& camera, double plane_height_m, const PixelPoint& low_px,
                const PixelPoint& high_px);

  /// True if every point of the rectangle shows the plane.
  bool valid() const { return coefficients_[0].allFinite() && coefficients_[1].allFinite(); }
  /// The row at `v_px`.
  RowPolynomial row(double v_px) const;
  /// t of a column, -1 to 1 over the rectangle.
  double t(double u_px) const { return (u_px - centre_px_.x()) / half_px_.x(); }

 private:
  PixelPoint centre_px_;
  PixelPoint half_px_;
  Eigen::Matrix<double, 5, 5>
      coefficients_[2];  ///< of x and y: powers of t down, powers of v across
};

}  // namespace nadir::vision
