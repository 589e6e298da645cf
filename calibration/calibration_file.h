#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "calibration/camera_place.h"
#include "calibration/field_points.h"
#include "calibration/fit/fit.h"
#include "calibration/plane_map.h"

namespace nadir::calibration {

/// The version of calibration files that this nadir writes. It reads version 1 too, which knew
/// polynomial2 alone, no hull of the points and no place of the camera.
inline constexpr int kCalibrationVersion = 2;

/// A plane map with what is known of how it was made. In a file: YAML, all numbers with full
/// precision.
struct Calibration {
  PlaneMap map;
  double height_m = 0.0;   ///< of the points' plane above the field
  int image_width_px = 0;  ///< 0 with image_height_px 0: unknown
  int image_height_px = 0;
  PixelBox points_box{};  ///< of the points that were fitted
  ResidualStatistics residuals{};
  StatedNoise noise{};
  std::optional<CameraPlace> camera{};  ///< absent: not known
};

/// The file's text.
std::string calibration_yaml(const Calibration& calibration);

/// Reads a calibration file strictly. Throws InputError: missing file, another version, unknown,
/// duplicate or missing key, value out of range.
Calibration load_calibration(const std::filesystem::path& file);

/// Throws InputError, naming `file`, if frames of this size cannot be those of the calibration:
/// another size than the stored one, or points that lie outside of the frame.
void check_image_size(const Calibration& calibration, const std::filesystem::path& file,
                      int width_px, int height_px);

}  // namespace nadir::calibration
