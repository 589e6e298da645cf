#pragma once

#include <optional>
#include <vector>

#include "calibration/field_points.h"
#include "calibration/plane_map.h"
#include "calibration/residuals.h"

namespace nadir::calibration {

/// What the user says about the errors of the points, one sigma per axis. Without a statement all
/// of the residual counts as an error of the model; with one of the two, the other counts as zero.
struct StatedNoise {
  std::optional<double> pixel_px;  ///< of finding a point in the image
  std::optional<double> survey_m;  ///< of measuring a point on the field

  bool is_stated() const { return pixel_px.has_value() || survey_m.has_value(); }
  /// Variance of x and y that a point with this Jacobian (m/px) has from both, m^2.
  Eigen::Vector2d variance_m2(const Eigen::Matrix2d& jacobian_m_per_px) const;
};

/// A map and how well it explains the points from which it was made.
struct FieldFit {
  PlaneMap map;
  std::vector<PointResidual> point_residuals;  ///< in the order of the points
  ResidualStatistics residuals;
  /// RMS distance that the stated noise alone would leave; 0 without a statement.
  double explained_rms_m = 0.0;
};

/// Least squares fit of a second-order polynomial (theory 4.4) on normalised pixel coordinates, by
/// column-pivoting QR, all points with equal weight.
///
/// What is left is split into noise and the map's local lack of fit by estimate_residual_field. The
/// noise is the stated one; without a statement it is estimated, and counts as lack of fit as well.
/// Exactly six points leave nothing: their noise is the stated one, or else that of one pixel.
///
/// Throws InputError: fewer than 6 points, a number that is not finite, one pixel with two
/// different places, points that do not determine the polynomial (on one line or one conic), places
/// from which no sound map follows (on one line, rows mixed up).
FieldFit fit_polynomial2(const FieldPoints& points, const StatedNoise& noise);

}  // namespace nadir::calibration
