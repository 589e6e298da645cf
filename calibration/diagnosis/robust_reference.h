#pragma once

#include <optional>
#include <vector>

#include "calibration/fit/fit.h"

namespace nadir::calibration {

/// A map that most points agree on, whatever the model that was asked for: what single points are
/// judged by. For diagnosis only, never a result.
struct RobustReference {
  PlaneMap map;
  std::vector<PointResidual> residuals;
  double sigma_m = 0.0;   ///< typical error per axis of a point about the map, on the plane
  double sigma_px = 0.0;  ///< and in the image
};

/// Several models by iteratively reweighted least squares, first with the weights of the sum of
/// distances, then with Tukey's biweight (Huber and Ronchetti, Robust Statistics, 2009, chapter 7);
/// the one about which the median distance is smallest for its number of parameters. Nothing where
/// no model can be fitted.
std::optional<RobustReference> robust_reference(const FieldPoints& points,
                                                const FitOptions& options = {});

}  // namespace nadir::calibration
