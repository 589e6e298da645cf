#pragma once

#include <string>

#include "calibration/compare/compare_maps.h"

namespace nadir::calibration {

/// How much two calibrations differ, where, and what that means: a map of numbers and sentences.
/// Lines, with an end of line each.
std::string comparison_summary(const MapComparison& comparison);
/// The same for a program: one JSON object; "map" has a row [u_px, v_px, dx_m, dy_m] for each
/// place.
std::string comparison_json(const MapComparison& comparison);

}  // namespace nadir::calibration
