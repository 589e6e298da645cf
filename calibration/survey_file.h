#pragma once

#include <filesystem>
#include <vector>

#include "calibration/camera_place.h"
#include "calibration/field_points.h"

namespace nadir::calibration {

/// A points file that may hold points at several heights.
struct Survey {
  FieldPoints plane;                  ///< at the plane's height
  std::vector<PointAtHeight> others;  ///< at other heights
};

/// Reads POINTS.csv as load_field_points does; with a further column z_m (height above the field),
/// rows whose z_m is not that of the plane stand apart: they tell where the camera is. Throws
/// InputError as load_field_points does, and where no row is at the plane's height.
Survey load_survey(const std::filesystem::path& file, double plane_height_m);

}  // namespace nadir::calibration
