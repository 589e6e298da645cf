#pragma once

#include <optional>
#include <vector>

#include "calibration/diagnosis/finding.h"
#include "calibration/diagnosis/robust_reference.h"

namespace nadir::calibration {

/// What is wrong with all points together: millimetres for metres (both columns or one), a mirrored
/// field (a wrong sign, or swapped columns), rows that are mixed up (kFail).
std::vector<Finding> set_findings(const FieldPoints& points,
                                  const std::optional<RobustReference>& reference);

/// What the points do not say: fewer than the parameters of the model (kFail, for their residuals
/// then say little of the error) or just few, parts of the image without points (kWarn; only where
/// the image's size is known, else 0), points on a narrow strip (kWarn), the same row twice.
std::vector<Finding> coverage_findings(ModelKind model, const FieldPoints& points, int width_px,
                                       int height_px);

}  // namespace nadir::calibration
