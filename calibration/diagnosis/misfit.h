#pragma once

#include <optional>
#include <vector>

#include "calibration/diagnosis/finding.h"
#include "calibration/fit/cross_validation.h"
#include "calibration/fit/fit.h"
#include "calibration/fit/leave_one_out.h"

namespace nadir::calibration {

/// Whether the model is to blame for what is left, and which would do better: "polynomial2 leaves
/// 70 mm RMS, the stated noise explains 1 mm, radial leaves 0.5 mm: use --model radial" (kWarn).
/// Also residuals that are too small to be measured ones, and noise that is not stated (kPass).
std::vector<Finding> misfit_findings(const StatedNoise& noise, const FieldFit& fit,
                                     const ModelChoice& choice,
                                     const std::optional<ChiSquareTest>& test);

}  // namespace nadir::calibration
