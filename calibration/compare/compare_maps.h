#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/calibration_file.h"
#include "vision/pixel.h"

namespace nadir::calibration {

/// What two calibrations make of one pixel.
struct PixelDifference {
  vision::PixelPoint pixel = vision::PixelPoint::Zero();
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();       ///< by the first
  Eigen::Vector2d difference_m = Eigen::Vector2d::Zero();  ///< second minus first
  double difference_px = 0.0;                              ///< the same seen in the image
  double expected_m = 0.0;  ///< RMS length that both calibrations' own errors explain
};

/// The difference as a motion of the field in its plane: what a knocked camera mostly does.
///
///     place by the second = shift + scale * rotation * (place by the first - centre) + centre
struct PlaneMotion {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d shift_m = Eigen::Vector2d::Zero();
  double turn_rad = 0.0;
  double scale = 1.0;
  double rest_rms_m = 0.0;  ///< what it leaves: tilt, another lens, another model
};

struct MapComparison {
  int columns = 0;  ///< of the grid
  int rows = 0;
  std::vector<PixelDifference> differences;  ///< row by row
  double rms_m = 0.0;
  double p95_m = 0.0;  ///< nearest rank
  double rms_px = 0.0;
  PixelDifference worst;
  double expected_rms_m = 0.0;
  PlaneMotion motion;
  bool is_significant = false;  ///< larger than both calibrations' own errors explain
};

/// Compares two calibrations of one camera on a grid of pixels where both have points. Throws
/// InputError, naming `first` and `second`, where the points of both share no part of the image, or
/// the images differ in size.
MapComparison compare_maps(const Calibration& a, const Calibration& b, const std::string& first,
                           const std::string& second);

}  // namespace nadir::calibration
