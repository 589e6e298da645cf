#pragma once

#include <Eigen/Core>
#include <optional>

#include "calibration/model_kind.h"
#include "vision/pixel.h"

namespace nadir::calibration {

/// Highest order of a polynomial map; storage is sized for it, so maps never allocate.
inline constexpr int kMaxPolynomialOrder = 5;

/// Number of terms of a polynomial in two variables: 6 for order 2.
constexpr int polynomial_terms(int order) { return (order + 1) * (order + 2) / 2; }
inline constexpr int kMaxPolynomialTerms = polynomial_terms(kMaxPolynomialOrder);

/// Vector of polynomial_terms(order) numbers.
using PolynomialBasis = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxPolynomialTerms, 1>;
/// 2 x terms: the row of x, the row of y.
using PolynomialCoefficients = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kMaxPolynomialTerms>;
/// terms x terms.
using PolynomialInformation = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                                            kMaxPolynomialTerms, kMaxPolynomialTerms>;

/// phi(u, v) in the order of theory 4.4, by rising degree: 1, u, v, u^2, u v, v^2, ...
/// `normalised` is a pixel in normalised coordinates, about -1 to 1.
PolynomialBasis polynomial_basis(const Eigen::Vector2d& normalised, int order);

/// Pixel to plane by a polynomial in both pixel coordinates (theory 4.4; Goncalves, Lima, Costa use
/// order 2):
///
///     n   = (pixel - centre_px) / scale_px
///     p   = coefficients_m phi(n)
///     J   = coefficients_m dphi/dn / scale_px
///     M   = sum of phi phi^T over the fitted points
///     C   = noise_variance phi^T M^-1 phi I        the sampling error of the coefficients
///
/// Where the noise of the points is known place by place, M^-1 (sum of w phi phi^T) M^-1 stands for
/// M^-1, with w the noise variance of a point against the mean one.
class PolynomialMap {
 public:
  struct Parameters {
    int order = 2;  ///< 1 to kMaxPolynomialOrder
    vision::PixelPoint centre_px = vision::PixelPoint::Zero();
    double scale_px = 1.0;                      ///< above 0
    PolynomialCoefficients coefficients_m;      ///< 2 x polynomial_terms(order)
    PolynomialInformation information_inverse;  ///< M^-1, terms x terms, no unit
    double noise_variance_m2 = 0.0;             ///< of the points, per axis
  };

  /// Throws std::invalid_argument where sizes do not belong to the order, or a number is out of
  /// range.
  explicit PolynomialMap(const Parameters& parameters);

  Eigen::Vector2d plane_from_pixel(const vision::PixelPoint& pixel) const;
  /// d(x_m, y_m)/d(u_px, v_px), in closed form.
  Eigen::Matrix2d jacobian_m_per_px(const vision::PixelPoint& pixel) const;
  /// phi^T M^-1 phi.
  double leverage(const vision::PixelPoint& pixel) const;
  /// leverage times the identity: the sampling covariance for a noise variance of 1.
  Eigen::Matrix2d unit_covariance(const vision::PixelPoint& pixel) const {
    return leverage(pixel) * Eigen::Matrix2d::Identity();
  }
  /// noise_variance phi^T M^-1 phi, m^2 per axis.
  double sampling_variance_m2(const vision::PixelPoint& pixel) const;
  /// Derivatives of x (first column) and y by those parameters on which each depends: phi twice.
  Eigen::MatrixX2d axis_basis(const vision::PixelPoint& pixel) const;
  /// The pixel that shows a place of the plane, by Newton's method from the linear guess, to
  /// 1e-9 m; nothing where it does not converge, or only beyond a fold of the map (where the image
  /// would be mirrored).
  std::optional<vision::PixelPoint> pixel_from_plane(const Eigen::Vector2d& plane_m) const;
  /// Where a search for a pixel starts.
  vision::PixelPoint centre_px() const { return parameters_.centre_px; }

  /// Of order 2 to 5.
  ModelKind kind() const;
  const Parameters& parameters() const { return parameters_; }

 private:
  Eigen::Vector2d normalised(const vision::PixelPoint& pixel) const {
    return (pixel - parameters_.centre_px) / parameters_.scale_px;
  }

  Parameters parameters_;
};

}  // namespace nadir::calibration
