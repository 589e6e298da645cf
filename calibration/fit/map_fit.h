#pragma once

#include <optional>
#include <vector>

#include "calibration/field_points.h"
#include "calibration/plane_map.h"
#include "vision/input/input_error.h"

namespace nadir::calibration {

struct FitOptions {
  /// Where the lens is centred, which `radial` takes as given and `radial2` starts from: the middle
  /// of the image. Without it, the middle of the points' box.
  std::optional<vision::PixelPoint> lens_centre_px{};
  /// Of the points' squared residuals, none negative; empty: all 1. Only for diagnosis.
  std::vector<double> weights{};
};

/// Least squares, all points with equal weight: the parameters and M^-1, with no noise and no
/// support. Fast: for halves of the data, folds and resampling.
///
/// Polynomials, which go from pixels to metres, minimise distances on the plane, by column-pivoting
/// QR on normalised pixel coordinates. Homographies and radial maps, which are cameras, minimise
/// distances in the image: from the linear equations of the direct linear transformation (Hartley
/// and Zisserman 2004, section 4.1) by Levenberg-Marquardt with analytic Jacobians.
///
/// Throws InputError: fewer than least_points(model), a number that is not finite, one pixel with
/// two different places, points that do not determine the model, places from which no sound map
/// follows (on one line, rows mixed up).
PlaneMap fit_map(ModelKind model, const FieldPoints& points, const FitOptions& options = {});

/// The two families, without the checks of the points.
PolynomialMap fit_polynomial_map(int order, const FieldPoints& points, const FitOptions& options);
RadialMap fit_radial_map(ModelKind model, const FieldPoints& points, const FitOptions& options);

/// "the points do not determine polynomial2: ..." as fit_map throws it.
vision::InputError undetermined_error(ModelKind model, const FieldPoints& points);

}  // namespace nadir::calibration
