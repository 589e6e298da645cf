#pragma once

#include <string>

#include "calibration/field_calibration.h"
#include "calibration/field_points.h"
#include "calibration/validation.h"

namespace nadir::calibration {

/// What a person wants to know of a fit: its grade, residuals in mm and px, cross-validation of all
/// models, the worst points, what the calibration adds to the error of a place, and findings.
/// Lines, with an end of line each.
std::string field_summary(const FieldPoints& points, const FieldResult& result);
/// The same for a program: one JSON object.
std::string field_json(const FieldPoints& points, const FieldResult& result);

std::string validation_summary(const Validation& validation);
/// {"points": n, "rms_m": .., "p95_m": .., "max_m": .., "coverage95": ..} on one line.
std::string validation_json(const Validation& validation);

}  // namespace nadir::calibration
