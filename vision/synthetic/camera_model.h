#pragma once

#include <Eigen/Core>

#include "vision/pixel.h"

namespace nadir::vision {

/// Where a camera hangs and what lens it has.
struct CameraParameters {
  int width_px = 1280;
  int height_px = 1024;
  double focal_px = 1275.0;
  double centre_u_px = 639.5;  ///< principal point, also the centre of the distortion
  double centre_v_px = 511.5;
  double x_m = 0.0;  ///< projection centre in the world
  double y_m = 0.0;
  double height_m = 6.0;            ///< above the field, positive
  double tilt_rad = 0.0;            ///< of the optical axis away from straight down, [0, 1.2]
  double tilt_direction_rad = 0.0;  ///< world direction towards which the axis leans, from x to y
  double pan_rad =
      0.0;          ///< turn about the vertical, counter-clockwise from above; 0: u is x, v is -y
  double k1 = 0.0;  ///< radial: distorted = r (1 + k1 r^2 + k2 r^4), r on the plane at distance 1
  double k2 = 0.0;
};

/// The synthetic camera's own geometry: pinhole, tilt and radial distortion. World: x, y on the
/// field, z up, right-handed. It knows nothing of calibrations, whose accuracy is judged with it.
class CameraModel {
 public:
  /// Throws std::invalid_argument where the camera cannot exist: size, focal length or height not
  /// positive, or a distortion that folds the image over itself before its corners.
  explicit CameraModel(const CameraParameters& parameters);

  /// Image of a world point, exact. NaN for points that are not in front of the camera.
  PixelPoint project(const Eigen::Vector3d& point_world_m) const;
  /// The point of the plane z = `plane_height_m` that is seen at a pixel: the inverse of project,
  /// to about 1e-12. NaN where the ray does not meet the plane in front of the camera.
  Eigen::Vector2d on_plane(const PixelPoint& pixel, double plane_height_m) const;
  /// d(u_px, v_px)/d(x_m, y_m) on the plane z = height, analytic.
  Eigen::Matrix2d pixels_per_metre(const Eigen::Vector3d& point_world_m) const;
  /// True if the pixel lies at least `margin_px` inside the image's outermost pixel centres.
  bool sees(const PixelPoint& pixel, double margin_px = 0.0) const;

  const CameraParameters& parameters() const { return parameters_; }
  int width_px() const { return parameters_.width_px; }
  int height_px() const { return parameters_.height_px; }

 private:
  double undistorted_radius(double distorted_radius) const;

  CameraParameters parameters_;
  Eigen::Matrix3d rotation_world_camera_;  ///< columns: u axis, v axis, optical axis
  Eigen::Vector3d centre_world_m_;
};

}  // namespace nadir::vision
