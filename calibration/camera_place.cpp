#include "calibration/camera_place.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vision/input/input_error.h"

namespace nadir::calibration {
namespace {

constexpr double kPrincipalPointSigma = 0.01;  // of the focal length
constexpr double kLowestCamera_m = 0.05;       // above the points' plane

/// Projection centre over the plane, height positive, from d plane/d ray.
Eigen::Vector3d projection_centre_m(const Eigen::Matrix3d& plane_from_ray) {
  Eigen::Matrix3d a = plane_from_ray.inverse();
  // Both columns of the rotation have length 1, and the plane lies in front of the camera.
  a /= 0.5 * (a.col(0).norm() + a.col(1).norm());
  if (a(2, 2) < 0.0) a = -a;
  Eigen::Matrix3d rotation;
  rotation << a.col(0), a.col(1), a.col(0).cross(a.col(1));
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rotation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  rotation = svd.matrixU() * svd.matrixV().transpose();
  Eigen::Vector3d centre_m = -rotation.transpose() * a.col(2);
  centre_m.z() = std::abs(centre_m.z());  // a mirrored field sees its camera from below
  return centre_m;
}

/// Homography parameters, then the focal length and the principal point in scales.
using Clues = Eigen::Matrix<double, 11, 1>;

Eigen::Vector3d centre_of(const Clues& clues) {
  Eigen::Matrix3d homography;
  homography << clues[0], clues[1], clues[2], clues[3], clues[4], clues[5], clues[6], clues[7], 1.0;
  Eigen::Matrix3d q_from_ray = Eigen::Matrix3d::Identity();
  q_from_ray.topLeftCorner<2, 2>() *= clues[8];
  q_from_ray.topRightCorner<2, 1>() = clues.tail<2>();
  return projection_centre_m(homography * q_from_ray);
}

}  // namespace

CameraPlace camera_from_focal(const PlaneMap& map, double focal_px, double plane_height_m) {
  const auto* pinhole = std::get_if<RadialMap>(&map.model());
  if (!pinhole) throw std::invalid_argument("only a pinhole map has a camera");
  const RadialMap::Parameters& p = pinhole->parameters();
  const Eigen::Matrix3d& h = p.homography_m;
  const double focal = focal_px / p.scale_px;
  Clues clues;
  clues << h(0, 0), h(0, 1), h(0, 2), h(1, 0), h(1, 1), h(1, 2), h(2, 0), h(2, 1), focal, 0.0, 0.0;
  Eigen::Matrix<double, 11, 11> covariance = Eigen::Matrix<double, 11, 11>::Zero();
  covariance.topLeftCorner<8, 8>() =
      p.noise_variance_m2 * p.information_inverse.topLeftCorner<8, 8>();
  covariance(8, 8) = std::pow(kFocalSigma * focal, 2);
  covariance(9, 9) = covariance(10, 10) = std::pow(kPrincipalPointSigma * focal, 2);
  Eigen::Matrix<double, 3, 11> jacobian;
  for (int i = 0; i < 11; ++i) {
    const double step = 1e-5 * std::max(1e-2, std::abs(clues[i]));
    const Clues change = step * Clues::Unit(i);
    jacobian.col(i) = (centre_of(clues + change) - centre_of(clues - change)) / (2.0 * step);
  }
  const Eigen::Vector3d centre_m = centre_of(clues);
  const Eigen::Matrix3d spread_m2 = jacobian * covariance * jacobian.transpose();
  return {centre_m.head<2>(), plane_height_m + centre_m.z(), spread_m2.topLeftCorner<2, 2>(),
          spread_m2(2, 2), CameraPlace::Source::kFocal};
}

CameraPlace camera_from_heights(const PlaneMap& map, double plane_height_m,
                                const std::vector<PointAtHeight>& others,
                                const StatedNoise& noise) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double square_m2 = 0.0;
  double expected_m2 = 0.0;
  const auto row = [&](const PointAtHeight& other) {
    const double d_m = other.height_m - plane_height_m;
    const Eigen::Vector2d mapped_m = map.plane_from_pixel(other.point.pixel);
    Eigen::Matrix<double, 2, 3> design;
    design << -d_m * mapped_m.x(), d_m, 0.0, -d_m * mapped_m.y(), 0.0, d_m;
    return std::pair(design, Eigen::Vector2d(other.point.position_m - mapped_m));
  };
  for (const PointAtHeight& other : others) {
    const auto [design, moved_m] = row(other);
    normal += design.transpose() * design;
    right += design.transpose() * moved_m;
    const vision::PixelPoint& pixel = other.point.pixel;
    expected_m2 +=
        0.5 *
        (noise.covariance_m2(map.jacobian_m_per_px(pixel)) + map.calibration_covariance_m2(pixel))
            .trace() /
        static_cast<double>(others.size());
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(normal);
  const Eigen::Vector3d solution = lu.solve(right);
  const double a = solution[0];
  const bool is_camera = lu.isInvertible() && a > 0.0 && 1.0 / a > kLowestCamera_m;
  if (!is_camera) {
    throw vision::InputError({}, "the points at another height do not say where the camera is",
                             "give three or more, far from each other, well above the others");
  }
  for (const PointAtHeight& other : others) {
    const auto [design, moved_m] = row(other);
    square_m2 += (moved_m - design * solution).squaredNorm();
  }
  const double free = 2.0 * static_cast<double>(others.size()) - 3.0;
  const double variance_m2 = std::max(expected_m2, free > 0.0 ? square_m2 / free : 0.0);
  const Eigen::Matrix3d covariance = variance_m2 * lu.inverse();
  Eigen::Matrix<double, 2, 3> nadir_jacobian;  // of solution.tail / a
  nadir_jacobian << -solution[1] / (a * a), 1.0 / a, 0.0, -solution[2] / (a * a), 0.0, 1.0 / a;
  return {solution.tail<2>() / a, plane_height_m + 1.0 / a,
          nadir_jacobian * covariance * nadir_jacobian.transpose(),
          covariance(0, 0) / std::pow(a, 4), CameraPlace::Source::kTwoHeights};
}

}  // namespace nadir::calibration
