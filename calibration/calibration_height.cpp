#include "calibration/calibration_height.h"

#include <cmath>

namespace nadir::calibration {
namespace {

constexpr double kAssumedHeightOfSide = 0.6;
constexpr double kAssumedNadirSigma = 0.25;  // of the field's side
/// A camera that is nearer to the markers than this sees nothing of them.
constexpr double kNearest_m = 0.05;

PlaneShift known_shift(const CameraPlace& camera, double from_m, double to_m) {
  const double above_m = camera.height_m - from_m;
  // scale = (H - h) / (H - h0); d scale/dH = (h - h0) / (H - h0)^2.
  const double by_height = (to_m - from_m) / (above_m * above_m);
  return {camera.nadir_m, (camera.height_m - to_m) / above_m, camera.nadir_covariance_m2,
          by_height * by_height * camera.height_variance_m2};
}

/// scale 1, and what that may cost.
PlaneShift unknown_shift(const Calibration& calibration, double difference_m) {
  const PixelBox& box = calibration.points_box;
  const Eigen::Vector2d low_m = calibration.map.plane_from_pixel(box.low_px);
  const Eigen::Vector2d high_m = calibration.map.plane_from_pixel(box.high_px);
  const Eigen::Vector2d side_m = (high_m - low_m).cwiseAbs();
  const double height_m = kAssumedHeightOfSide * side_m.maxCoeff();
  if (!(height_m > 0.0)) return {};
  return {0.5 * (low_m + high_m), 1.0, (kAssumedNadirSigma * side_m).cwiseAbs2().asDiagonal(),
          std::pow(difference_m / height_m, 2)};
}

bool is_usable(const Calibration& calibration, double height_m) {
  return calibration.camera && calibration.camera->height_m > height_m + kNearest_m &&
         calibration.camera->height_m > calibration.height_m + kNearest_m;
}

}  // namespace

bool is_corrected_at_height(const Calibration& calibration, double height_m) {
  return std::abs(height_m - calibration.height_m) <= kSameHeight_m ||
         is_usable(calibration, height_m);
}

PlaneMap map_at_height(const Calibration& calibration, double height_m) {
  const double difference_m = height_m - calibration.height_m;
  if (is_usable(calibration, height_m)) {
    return calibration.map.shifted(
        known_shift(*calibration.camera, calibration.height_m, height_m));
  }
  if (std::abs(difference_m) <= kSameHeight_m) return calibration.map;
  return calibration.map.shifted(unknown_shift(calibration, difference_m));
}

}  // namespace nadir::calibration
