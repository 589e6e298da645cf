#pragma once

#include <optional>
#include <vector>

#include "calibration/field_points.h"
#include "calibration/fit/map_fit.h"
#include "calibration/fit/residuals.h"
#include "calibration/plane_map.h"

namespace nadir::calibration {

/// What the user says about the errors of the points, one sigma per axis. Without a statement all
/// of the residual counts as an error of the model; with one of the two, the other counts as zero.
struct StatedNoise {
  std::optional<double> pixel_px;  ///< of finding a point in the image
  std::optional<double> survey_m;  ///< of measuring a point on the field

  bool is_stated() const { return pixel_px.has_value() || survey_m.has_value(); }
  /// Covariance of the place of a point with this Jacobian (m/px) from both, m^2.
  Eigen::Matrix2d covariance_m2(const Eigen::Matrix2d& jacobian_m_per_px) const;
  /// Its diagonal.
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

/// fit_map with the sampling error that the stated noise leaves in the parameters, and nothing said
/// of the model's own error: what the covariance would be if the model were right. Fast.
PlaneMap fit_sampled_map(ModelKind model, const FieldPoints& points, const StatedNoise& noise,
                         const FitOptions& options = {});

/// Plain least squares fit (fit_map), and what its residuals say of its error.
///
/// What is left is split into noise and the map's local lack of fit by estimate_residual_field. The
/// noise is the stated one, place by place where it is one of pixels; without a statement it is
/// estimated, and counts as lack of fit as well. So few points that nothing is left have the stated
/// noise, or else that of one pixel.
///
/// Throws InputError as fit_map does.
FieldFit fit_field(ModelKind model, const FieldPoints& points, const StatedNoise& noise,
                   const FitOptions& options = {});

/// fit_field with a second-order polynomial (theory 4.4).
FieldFit fit_polynomial2(const FieldPoints& points, const StatedNoise& noise);

}  // namespace nadir::calibration
