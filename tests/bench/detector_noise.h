#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "vision/synthetic/scene.h"

namespace nadir::bench {

// How well robots with two marks are placed against the number of pixels that show a mark: the same
// scene from cameras near and far, whose calibration is exact (no tilt, no distortion), so that
// nothing but the measurement errs.

/// What is published as variance, as --variance says: of aligned poses the Fisher information, a
/// law of pixel counts, a table of them; of the detector's poses the variance in the discs' pixels.
/// In the order of CountNoise::published.
inline constexpr std::array<const char*, 4> kVarianceLaws = {"fisher", "law", "table", "pixels"};
inline constexpr std::size_t kDetectorLaw = 3;

/// Of a place, mean of the x and the y axis, and of the heading.
struct PoseVariance {
  double place_m2 = 0.0;
  double heading_rad2 = 0.0;
};

/// One camera distance: a number of pixels.
struct CountNoise {
  double expected_pixels = 0.0;  ///< area of a mark in the image
  double pixels_per_metre = 0.0;
  int robots = 0;        ///< shown
  int found = 0;         ///< reported within half a mark's radius of the truth
  int aligned = 0;       ///< of the found ones; errors are of these, by all variances
  int false_robots = 0;  ///< reported elsewhere
  double pixels = 0.0;   ///< counted of the centre mark, mean
  double x_m2 = 0.0;     ///< mean squared error of each axis
  double y_m2 = 0.0;
  PoseVariance measured;           ///< of aligned poses
  PoseVariance measured_detector;  ///< of the detector's
  /// Mean of what is published for the robots found; a law may take fewer for a measurement.
  std::array<PoseVariance, kVarianceLaws.size()> published;
  std::array<int, kVarianceLaws.size()> published_robots{};
  std::array<double, kVarianceLaws.size()> nees{};  ///< means; 3 if the covariance holds

  double found_share() const { return static_cast<double>(found) / robots; }
  double place_px2() const { return measured.place_m2 * pixels_per_metre * pixels_per_metre; }
};

struct NoiseStudy {
  std::string sensor;
  std::vector<CountNoise> counts;

  /// Share found of all robots whose marks have this many pixels.
  double found_share(double least_pixels, double most_pixels) const;
};

/// `scene` gives everything but the camera's distance; `expected_pixels` of a mark, one camera
/// each. `table_file` is the noise file of the third law.
NoiseStudy study_detector_noise(const std::string& sensor, const vision::Scene& scene,
                                const std::vector<double>& expected_pixels, int frames,
                                const std::filesystem::path& table_file);

/// `count` numbers from `first` to `last` in equal ratios.
std::vector<double> in_equal_ratios(double first, double last, int count);

}  // namespace nadir::bench
