#pragma once

#include <Eigen/Core>
#include <optional>

#include "calibration/model_kind.h"
#include "vision/pixel.h"

namespace nadir::calibration {

/// Most parameters of a radial map; storage is sized for it, so maps never allocate.
inline constexpr int kMaxRadialParameters = 12;

/// Parameters x parameters.
using RadialInformation = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                                        kMaxRadialParameters, kMaxRadialParameters>;
/// 2 x parameters: d(x_m, y_m)/d(parameters).
using RadialParameterJacobian =
    Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kMaxRadialParameters>;

/// Pixel to plane through a pinhole camera with radial lens distortion (Brown 1971; Hartley and
/// Zisserman, Multiple View Geometry, 2004, sections 2.3 and 7.4):
///
///     d     = (pixel - centre_px) / scale_px             as the image shows it
///     d     = q (1 + k1 r^2 + k2 r^4),  r = |q|          q: without distortion
///     place = (h0 . m, h1 . m) / (h2 . m),  m = (q, 1)   rows of the homography, h22 = 1
///
/// The image scale stands for the focal length, which one plane does not tell: k1 here is that of
/// a camera times (scale_px / focal_px)^2. A homography is the same with k1 = k2 = 0.
///
/// The parameters are, in order, h00 h01 h02 h10 h11 h12 h20 h21, then k1 (radial), then k2 and the
/// centre u, v in units of scale_px (radial2). The sampling covariance is noise_variance D M^-1 D^T
/// with D = d place/d parameters and, since the fit measures distances in the image,
///
///     M = s^2 sum of G^T G,  G = J^-1 D,  J = d place/d pixel,  s^2 = mean of |J|^2 / 2
///
/// (weighted by the points' noise as in PolynomialMap).
///
/// Beyond the radius where the lens would fold the image over itself, q goes on in a straight line,
/// so that every pixel has a place, although a worthless one.
class RadialMap {
 public:
  struct Parameters {
    ModelKind kind = ModelKind::kHomography;  ///< kHomography, kRadial or kRadial2
    vision::PixelPoint centre_px = vision::PixelPoint::Zero();
    double scale_px = 1.0;  ///< above 0
    Eigen::Matrix3d homography_m = Eigen::Matrix3d::Identity();
    double k1 = 0.0;
    double k2 = 0.0;
    RadialInformation information_inverse;  ///< M^-1
    double noise_variance_m2 = 0.0;         ///< of the points, per axis
  };

  /// Throws std::invalid_argument where sizes do not belong to the kind, or a number is out of
  /// range.
  explicit RadialMap(const Parameters& parameters);

  Eigen::Vector2d plane_from_pixel(const vision::PixelPoint& pixel) const;
  /// d(x_m, y_m)/d(u_px, v_px), in closed form.
  Eigen::Matrix2d jacobian_m_per_px(const vision::PixelPoint& pixel) const;
  /// The pixel that shows a place of the plane, in closed form; nothing for places behind the
  /// camera or beyond the fold of the lens.
  std::optional<vision::PixelPoint> pixel_from_plane(const Eigen::Vector2d& plane_m) const;
  /// D.
  RadialParameterJacobian parameter_jacobian(const vision::PixelPoint& pixel) const;
  /// D M^-1 D^T: the sampling covariance for a noise variance of 1.
  Eigen::Matrix2d unit_covariance(const vision::PixelPoint& pixel) const;
  /// Derivatives of x (first column) and y by those parameters on which each depends.
  Eigen::MatrixX2d axis_basis(const vision::PixelPoint& pixel) const;
  /// Where a search for a pixel starts.
  vision::PixelPoint centre_px() const { return parameters_.centre_px; }

  ModelKind kind() const { return parameters_.kind; }
  const Parameters& parameters() const { return parameters_; }

 private:
  struct Undistorted;
  Undistorted undistorted(const vision::PixelPoint& pixel) const;
  /// d place/d q.
  Eigen::Matrix2d projection_jacobian(const Eigen::Vector2d& q) const;

  Parameters parameters_;
  double fold_radius_ = 0.0;  ///< of q
};

}  // namespace nadir::calibration
