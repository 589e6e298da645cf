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
  /// Variance per axis that a point with this Jacobian (m/px) has from both, m^2.
  double variance_m2(const Eigen::Matrix2d& jacobian_m_per_px) const;
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
/// The residual variance is what the points show, with 2 (n - 6) degrees of freedom; where exactly
/// six points leave none, it is the stated noise, or else that of one pixel. The lack-of-fit
/// variance of the map is what the stated noise leaves unexplained of it: max(0, residual variance
/// - mean noise variance).
///
/// Throws InputError: fewer than 6 points, a number that is not finite, one pixel with two
/// different places, points that do not determine the polynomial (on one line or one conic), places
/// from which no sound map follows (on one line, rows mixed up).
FieldFit fit_polynomial2(const FieldPoints& points, const StatedNoise& noise);

}  // namespace nadir::calibration
