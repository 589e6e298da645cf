#pragma once

#include <vector>

#include "calibration/diagnosis/finding.h"
#include "calibration/diagnosis/robust_reference.h"

namespace nadir::calibration {

/// Single rows that are wrong, with their lines and, where one change puts them right, that change:
/// two rows with each other's places, x_m and y_m of a row swapped, a wrong sign, a wrong unit, one
/// coordinate off by so much, a place that another row has already. All are kFail, but what is off
/// by less than 5 px and not explained, which is kWarn.
///
/// A point is wrong that stands out by 7 sigma of the reference both on the plane and in the image,
/// and as far from what its neighbours' residuals say.
std::vector<Finding> point_findings(const FieldPoints& points, const RobustReference& reference,
                                    const StatedNoise& noise);

}  // namespace nadir::calibration
