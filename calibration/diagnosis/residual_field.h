#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "calibration/diagnosis/lack_of_fit.h"
#include "calibration/pixel_box.h"
#include "vision/pixel.h"

namespace nadir::calibration {

/// What a least squares fit with equal weights left of its points.
struct FitResiduals {
  PixelBox box{};                          ///< of the points, with extent on both sides
  std::vector<vision::PixelPoint> pixels;  ///< n of them
  Eigen::MatrixX2d error_m;                ///< n x 2, surveyed minus mapped place
  /// phi of the fit at a pixel, a column an axis: the derivatives of x, of y by the parameters.
  std::function<Eigen::MatrixX2d(const vision::PixelPoint&)> basis;
  /// Standard deviation of a point's noise at a pixel against the root of the mean variance, per
  /// axis. Errors and basis are divided by it, so that all points have the same noise.
  std::function<Eigen::Vector2d(const vision::PixelPoint&)> noise_scale =
      [](const vision::PixelPoint&) { return Eigen::Vector2d::Ones().eval(); };
};

struct ResidualEstimate {
  LackOfFit lack_of_fit;
  Eigen::Vector2d noise_variance_m2 = Eigen::Vector2d::Zero();  ///< per axis
};

/// Splits residuals into a smooth field, which is the model's own error, and noise.
///
/// The points' error per axis about a map of the fit's model is taken as g + noise with a Gaussian
/// process g (Matern 5/2; Rasmussen and Williams, Gaussian Processes for Machine Learning,
/// 2006, sections 2.7 and 4.2). Contrasts z = A^T error with A^T Phi = 0 (Phi: a row
/// phi^T a point) are free of the parameters. At a pixel the fit is off by
///
///     d = g(pixel) - a^T (g_points + noise),   a = Phi M^-1 phi(pixel)
///
/// and E[d^2 | z] = E[d | z]^2 + Var[g part of d | z] + noise variance a^T a. The last is the
/// sampling error that the map has anyway; the first two are the nodes of the lack of fit, which
/// therefore grows with the distance from the points and goes to zero where the noise explains all.
/// Length, strength of g and, where it is not stated, the noise are not chosen but averaged over
/// with their restricted likelihoods.
///
/// A model whose axes share parameters is taken as if each axis had its own: what the shared fit
/// leaves of the residuals is moved back exactly, only the knowledge that both agree is not used.
/// Of many points an even selection is taken.
///
/// `stated_variance_m2`: the points' noise per axis. Without it the noise that is found counts as
/// error of the model in every place, which is the careful choice. At least one contrast is needed
/// (n > number of terms).
ResidualEstimate estimate_residual_field(const FitResiduals& fit,
                                         const std::optional<Eigen::Vector2d>& stated_variance_m2);

}  // namespace nadir::calibration
