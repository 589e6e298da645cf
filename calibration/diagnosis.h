#pragma once

#include <string>
#include <vector>

#include "calibration/fit.h"

namespace nadir::calibration {

/// What a person should know before trusting a fit, the gravest first, each one sentence or two:
/// the model does not fit, points too good to be measured, single points that stand out (with their
/// lines), a mirrored field, few points, no noise stated. Empty where there is nothing to say.
std::vector<std::string> fit_remarks(const FieldPoints& points, const StatedNoise& noise,
                                     const FieldFit& fit);

/// Indices of the points with the largest residuals, the worst first.
std::vector<std::size_t> worst_points(const FieldFit& fit, std::size_t count);

}  // namespace nadir::calibration
