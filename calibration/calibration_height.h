#pragma once

#include "calibration/calibration_file.h"

namespace nadir::calibration {

/// Heights that differ by less count as the same, m.
inline constexpr double kSameHeight_m = 0.001;

/// The map for markers at `height_m` above the field. Where the camera's place is known, places are
/// corrected for parallax (plane_shift.h). Where it is not, they are left as they are, and the
/// covariance takes in what they may be off by: as if the camera hung in the middle of the points,
/// give or take a quarter of the field they cover, as high above them as 0.6 of that field's longer
/// side (a lens of 80 degrees; with a longer lens the error is smaller).
PlaneMap map_at_height(const Calibration& calibration, double height_m);

/// Whether map_at_height corrects for this height, or need not.
bool is_corrected_at_height(const Calibration& calibration, double height_m);

}  // namespace nadir::calibration
