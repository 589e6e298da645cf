#pragma once

#include <filesystem>
#include <optional>

#include "calibration/pixel_count_variance.h"

namespace nadir::calibration {

/// Error of the centre of an aligned mark, px per axis, that neither the frame's noise nor its
/// residuals tell of: what the pixel grid and the template's own rounding leave, measured with the
/// synthetic camera.
inline constexpr double kAlignmentFloor_px = 0.001;

/// What NOISE.yaml says of one camera.
struct NoiseFile {
  PixelCountVariance variance;
  /// In place of kAlignmentFloor_px, where recordings of standing robots showed more.
  std::optional<double> alignment_floor_px;
};

/// Reads NOISE.yaml strictly (formats: calibration/README.md). Throws InputError.
NoiseFile load_noise_file(const std::filesystem::path& file);
/// The first half of it.
PixelCountVariance load_pixel_count_variance(const std::filesystem::path& file);

}  // namespace nadir::calibration
