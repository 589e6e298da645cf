#pragma once

#include <vector>

#include "calibration/field_points.h"
#include "calibration/plane_map.h"

namespace nadir::calibration {

/// What a map leaves of one point: surveyed place minus mapped place.
struct PointResidual {
  Eigen::Vector2d error_m = Eigen::Vector2d::Zero();
  double distance_m = 0.0;   ///< length of error_m
  double distance_px = 0.0;  ///< the same seen in the image, through the inverse Jacobian
};

/// Distances (not per axis) over all points. The 95th percentile is the nearest rank.
struct ResidualStatistics {
  int points = 0;
  double rms_m = 0.0;
  double p95_m = 0.0;
  double max_m = 0.0;
  double rms_px = 0.0;
  double p95_px = 0.0;
  double max_px = 0.0;
};

std::vector<PointResidual> point_residuals(const PlaneMap& map, const FieldPoints& points);

/// The same of errors that were found otherwise, surveyed minus mapped place; `map` tells the
/// scale.
std::vector<PointResidual> residuals_of(const std::vector<Eigen::Vector2d>& errors_m,
                                        const PlaneMap& map, const FieldPoints& points);

/// Of at least one residual.
ResidualStatistics residual_statistics(const std::vector<PointResidual>& residuals);

}  // namespace nadir::calibration
