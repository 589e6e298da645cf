#pragma once

#include "calibration/calibration_file.h"
#include "calibration/field_points.h"

namespace nadir::calibration {

/// How a calibration does on points that it need not have seen.
struct Validation {
  ResidualStatistics residuals;
  /// Share of the points inside the 95 % ellipse of what is predicted for a point: the
  /// calibration's covariance plus the noises that were stated when it was made. About 0.95 where
  /// the covariance is honest and noise is what errs; up to 1 where the model does, for its local
  /// error is then known to be about one sigma.
  double coverage95 = 0.0;
};

/// Of at least one point, on the plane of the calibration.
Validation validate(const Calibration& calibration, const FieldPoints& points);

}  // namespace nadir::calibration
