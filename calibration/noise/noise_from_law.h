#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/noise/noise_from_standing.h"
#include "calibration/noise_file.h"

namespace nadir::calibration {

/// What a law of the noise is asked to do.
struct NoiseLawSettings {
  /// What a detected centre's error has of the pixel grid, px^2 times the root of the pixel count.
  /// It stays the same while a robot stands, so standing robots do not show it
  /// (vision/disc_measurement.h).
  double grid_variance_px2 = 0.0;
  /// The same of an aligned mark, px^2 whatever its count.
  double aligned_grid_variance_px2 = kAlignmentFloor_px * kAlignmentFloor_px;
  bool table = false;  ///< a variance for each class of counts instead of the 1/N law
  /// Samples of standing robots without which there is no fit: 100 give the variance within 10 %
  /// (one sigma), as each has two axes.
  int least_samples = 100;
};

/// Robots whose marks have about the same number of pixels.
struct PixelClass {
  double from_pixels = 0.0;  ///< half open, up to the next class
  double pixels = 0.0;       ///< mean of the marks
  int samples = 0;
  Eigen::Vector3d pose_variance = Eigen::Vector3d::Zero();  ///< of x m^2, y m^2, heading rad^2
  Eigen::Vector2d mark_variance_m2 =
      Eigen::Vector2d::Zero();    ///< of one mark, x and y, grid included
  double grid_variance_m2 = 0.0;  ///< of it, what the pixel grid has
  double law_ratio = 0.0;         ///< mark_variance_m2 against the fitted law
};

struct NoiseFit {
  PixelCountVariance::Law law;
  LawVariance one_over_n;  ///< the fitted law, also where a table was asked for
  bool has_floor = false;  ///< counts differ enough to tell the floor from the 1/N part
  double exponent = -1.0;  ///< of a power law through the classes; -1 with one class
  /// Of aligned marks: the error that makes their published covariances explain how they scattered.
  /// Nothing where no recording has aligned poses.
  std::optional<double> alignment_floor_px;
  double relative_error = 0.0;      ///< of the variance, one sigma, from the number of samples
  std::vector<PixelClass> classes;  ///< by rising pixel count
  std::vector<std::string> remarks;
};

/// Fits variance = pixel_variance / N + floor per axis and mark (theory 4.1 c, 4.3) to what stands,
/// by maximum likelihood: the variance s^2 of a span's middle with n degrees of freedom is
/// chi-square distributed about
///
///     V = 1 / sum over the marks of 1 / (pixel_variance / N_i + floor)
///
/// which is what the tracker makes of the marks' variances. Throws InputError, naming `files`, with
/// what is missing where too little stands.
NoiseFit fit_noise(const StandingData& data, const NoiseLawSettings& settings,
                   const std::string& files);

}  // namespace nadir::calibration
