#include "vision/synthetic/camera_model.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace nadir::vision {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Eigen::Matrix3d camera_axes(const CameraParameters& camera) {
  Eigen::Matrix3d untilted;
  untilted.col(0) = Eigen::Vector3d(std::cos(camera.pan_rad), std::sin(camera.pan_rad), 0.0);
  untilted.col(1) = Eigen::Vector3d(std::sin(camera.pan_rad), -std::cos(camera.pan_rad), 0.0);
  untilted.col(2) = -Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d lean(std::cos(camera.tilt_direction_rad),
                             std::sin(camera.tilt_direction_rad), 0.0);
  const Eigen::Vector3d hinge = lean.cross(Eigen::Vector3d::UnitZ());
  return Eigen::AngleAxisd(camera.tilt_rad, hinge).toRotationMatrix() * untilted;
}

/// Radius at which the distortion stops growing, infinity if never.
double fold_radius(double k1, double k2) {
  // d/dr of r (1 + k1 r^2 + k2 r^4) = 1 + 3 k1 q + 5 k2 q^2 with q = r^2: its smallest positive
  // root.
  const double infinity = std::numeric_limits<double>::infinity();
  if (k2 == 0.0) return k1 < 0.0 ? std::sqrt(-1.0 / (3.0 * k1)) : infinity;
  const double discriminant = 9.0 * k1 * k1 - 20.0 * k2;
  if (discriminant < 0.0) return infinity;
  const double low = (-3.0 * k1 - std::sqrt(discriminant)) / (10.0 * k2);
  const double high = (-3.0 * k1 + std::sqrt(discriminant)) / (10.0 * k2);
  double smallest = infinity;
  if (low > 0.0) smallest = low;
  if (high > 0.0 && high < smallest) smallest = high;
  return std::sqrt(smallest);
}

double distorted(double radius, double k1, double k2) {
  const double q = radius * radius;
  return radius * (1.0 + q * (k1 + q * k2));
}

}  // namespace

CameraModel::CameraModel(const CameraParameters& parameters)
    : parameters_(parameters),
      rotation_world_camera_(camera_axes(parameters)),
      centre_world_m_(parameters.x_m, parameters.y_m, parameters.height_m) {
  const CameraParameters& p = parameters_;
  if (p.width_px < 1 || p.height_px < 1 || !(p.focal_px > 0.0) || !(p.height_m > 0.0)) {
    throw std::invalid_argument("camera size, focal length and height must be positive");
  }
  const double reach_u_px = std::max(p.centre_u_px + 0.5, p.width_px - 0.5 - p.centre_u_px);
  const double reach_v_px = std::max(p.centre_v_px + 0.5, p.height_px - 0.5 - p.centre_v_px);
  // Robots at the border reach out of the image: 5 % more than the corner.
  const double corner = 1.05 * std::hypot(reach_u_px, reach_v_px) / p.focal_px;
  const double fold = fold_radius(p.k1, p.k2);
  if (std::isfinite(fold) && distorted(fold, p.k1, p.k2) < corner) {
    throw std::invalid_argument("the distortion folds the image over before its corners");
  }
}

PixelPoint CameraModel::project(const Eigen::Vector3d& point_world_m) const {
  const Eigen::Vector3d point =
      rotation_world_camera_.transpose() * (point_world_m - centre_world_m_);
  if (!(point.z() > 0.0)) return {kNan, kNan};
  const Eigen::Vector2d ideal = point.head<2>() / point.z();
  const double q = ideal.squaredNorm();
  const double stretch = 1.0 + q * (parameters_.k1 + q * parameters_.k2);
  return parameters_.focal_px * stretch * ideal +
         PixelPoint(parameters_.centre_u_px, parameters_.centre_v_px);
}

double CameraModel::undistorted_radius(double distorted_radius) const {
  double radius = distorted_radius;
  for (int i = 0; i < 30; ++i) {
    const double q = radius * radius;
    const double slope = 1.0 + q * (3.0 * parameters_.k1 + q * 5.0 * parameters_.k2);
    if (!(slope > 0.0)) return kNan;
    const double step =
        (distorted(radius, parameters_.k1, parameters_.k2) - distorted_radius) / slope;
    radius -= step;
    if (std::abs(step) <= 1e-15 * radius) break;
  }
  return radius;
}

Eigen::Vector2d CameraModel::on_plane(const PixelPoint& pixel, double plane_height_m) const {
  const Eigen::Vector2d bent =
      (pixel - PixelPoint(parameters_.centre_u_px, parameters_.centre_v_px)) / parameters_.focal_px;
  const double distorted_radius = bent.norm();
  const double shrink =
      distorted_radius > 0.0 ? undistorted_radius(distorted_radius) / distorted_radius : 1.0;
  const Eigen::Vector3d ray =
      rotation_world_camera_ * Eigen::Vector3d(shrink * bent.x(), shrink * bent.y(), 1.0);
  const double distance = (plane_height_m - centre_world_m_.z()) / ray.z();
  if (!(distance > 0.0) || !std::isfinite(distance)) return {kNan, kNan};
  return centre_world_m_.head<2>() + distance * ray.head<2>();
}

Eigen::Matrix2d CameraModel::pixels_per_metre(const Eigen::Vector3d& point_world_m) const {
  const Eigen::Matrix3d rotation = rotation_world_camera_.transpose();
  const Eigen::Vector3d point = rotation * (point_world_m - centre_world_m_);
  const Eigen::Vector2d ideal = point.head<2>() / point.z();
  const double q = ideal.squaredNorm();
  const double stretch = 1.0 + q * (parameters_.k1 + q * parameters_.k2);
  const double stretch_slope = 2.0 * (parameters_.k1 + 2.0 * parameters_.k2 * q);
  const Eigen::Matrix2d bend =
      stretch * Eigen::Matrix2d::Identity() + stretch_slope * ideal * ideal.transpose();
  Eigen::Matrix<double, 2, 3> perspective;
  perspective << 1.0, 0.0, -ideal.x(), 0.0, 1.0, -ideal.y();
  perspective /= point.z();
  return parameters_.focal_px * bend * perspective * rotation.leftCols<2>();
}

bool CameraModel::sees(const PixelPoint& pixel, double margin_px) const {
  return pixel.x() >= margin_px && pixel.y() >= margin_px &&
         pixel.x() <= parameters_.width_px - 1 - margin_px &&
         pixel.y() <= parameters_.height_px - 1 - margin_px;
}

}  // namespace nadir::vision
