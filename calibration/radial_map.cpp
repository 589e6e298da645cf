#include "calibration/radial_map.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace nadir::calibration {
namespace {

/// d|d|/d|q| below which the lens counts as folding: an image there says nothing of the place.
constexpr double kLeastSlope = 0.02;
constexpr int kMaxNewtonSteps = 60;

/// |d| for |q| = r.
double distorted_radius(const RadialMap::Parameters& p, double r) {
  return r * (1.0 + r * r * (p.k1 + p.k2 * r * r));
}

double slope(const RadialMap::Parameters& p, double r) {
  return 1.0 + r * r * (3.0 * p.k1 + 5.0 * p.k2 * r * r);
}

/// The smallest radius at which the slope is kLeastSlope; infinity where there is none.
double fold_radius(const RadialMap::Parameters& p) {
  // 5 k2 s^2 + 3 k1 s + (1 - least) = 0 with s = r^2, in the form that survives k2 = 0.
  const double rest = 1.0 - kLeastSlope;
  const double discriminant = 9.0 * p.k1 * p.k1 - 20.0 * p.k2 * rest;
  if (discriminant < 0.0) return std::numeric_limits<double>::infinity();
  const double denominator = -3.0 * p.k1 + std::sqrt(discriminant);
  const double s = 2.0 * rest / denominator;
  return denominator > 0.0 ? std::sqrt(s) : std::numeric_limits<double>::infinity();
}

/// |q| for |d| below the fold: Newton's method, kept inside of the bracket.
double undistorted_radius(const RadialMap::Parameters& p, double fold, double d) {
  double low = 0.0;
  double high = std::min(fold, d / kLeastSlope);
  double r = std::min(d, high);
  for (int step = 0; step < kMaxNewtonSteps; ++step) {
    const double excess = distorted_radius(p, r) - d;
    (excess > 0.0 ? high : low) = r;
    double next = r - excess / slope(p, r);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double moved = std::abs(next - r);
    r = next;
    if (moved <= 1e-16 * r) break;
  }
  return r;
}

void check(const RadialMap::Parameters& p) {
  const bool is_radial = p.kind == ModelKind::kRadial || p.kind == ModelKind::kRadial2;
  if (p.kind != ModelKind::kHomography && !is_radial) {
    throw std::invalid_argument("radial map: the kind is a polynomial");
  }
  const int count = parameter_count(p.kind);
  if (p.information_inverse.rows() != count || p.information_inverse.cols() != count) {
    throw std::invalid_argument("radial map: sizes do not belong to the kind");
  }
  const bool is_finite = p.homography_m.allFinite() && p.information_inverse.allFinite() &&
                         p.centre_px.allFinite() && std::isfinite(p.k1) && std::isfinite(p.k2);
  if (!is_finite || !(p.scale_px > 0.0) || !(p.noise_variance_m2 >= 0.0) ||
      p.homography_m(2, 2) != 1.0 || p.homography_m.determinant() == 0.0) {
    throw std::invalid_argument("radial map: number out of range");
  }
}

}  // namespace

/// q and its derivatives.
struct RadialMap::Undistorted {
  Eigen::Vector2d q = Eigen::Vector2d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();  ///< unit vector from the centre
  double radius = 0.0;                                  ///< |q|, at most the fold's
  double slope = 1.0;                                   ///< d|d|/d|q|
  Eigen::Matrix2d by_distorted = Eigen::Matrix2d::Identity();
};

RadialMap::RadialMap(const Parameters& parameters)
    : parameters_(parameters), fold_radius_(fold_radius(parameters)) {
  check(parameters_);
}

RadialMap::Undistorted RadialMap::undistorted(const vision::PixelPoint& pixel) const {
  const Eigen::Vector2d distorted = (pixel - parameters_.centre_px) / parameters_.scale_px;
  const double d = distorted.norm();
  Undistorted result;
  if (!(d > 1e-12) || (parameters_.k1 == 0.0 && parameters_.k2 == 0.0)) {
    result.q = distorted;
    result.radius = d;
    if (d > 1e-12) result.direction = distorted / d;
    return result;
  }
  result.direction = distorted / d;
  const bool is_beyond =
      std::isfinite(fold_radius_) && d > distorted_radius(parameters_, fold_radius_);
  result.radius = is_beyond ? fold_radius_ : undistorted_radius(parameters_, fold_radius_, d);
  result.slope = slope(parameters_, result.radius);
  double length = result.radius;
  if (is_beyond) length += (d - distorted_radius(parameters_, fold_radius_)) / result.slope;
  result.q = length * result.direction;
  const Eigen::Matrix2d radial = result.direction * result.direction.transpose();
  result.by_distorted = length / d * (Eigen::Matrix2d::Identity() - radial) + radial / result.slope;
  return result;
}

Eigen::Vector2d RadialMap::plane_from_pixel(const vision::PixelPoint& pixel) const {
  return (parameters_.homography_m * undistorted(pixel).q.homogeneous()).hnormalized();
}

Eigen::Matrix2d RadialMap::projection_jacobian(const Eigen::Vector2d& q) const {
  const Eigen::Vector3d image = parameters_.homography_m * q.homogeneous();
  const Eigen::Vector2d place_m = image.hnormalized();
  return (parameters_.homography_m.topLeftCorner<2, 2>() -
          place_m * parameters_.homography_m.bottomLeftCorner<1, 2>()) /
         image.z();
}

Eigen::Matrix2d RadialMap::jacobian_m_per_px(const vision::PixelPoint& pixel) const {
  const Undistorted at = undistorted(pixel);
  return projection_jacobian(at.q) * at.by_distorted / parameters_.scale_px;
}

std::optional<vision::PixelPoint> RadialMap::pixel_from_plane(
    const Eigen::Vector2d& plane_m) const {
  const Eigen::Vector3d image = parameters_.homography_m.inverse() * plane_m.homogeneous();
  const Eigen::Vector2d q = image.hnormalized();
  // In front of the camera h2 . m is positive, as it is in the centre, where it is 1.
  const double depth = parameters_.homography_m.row(2).dot(q.homogeneous());
  const double r = q.norm();
  if (!(depth > 0.0) || !(r <= fold_radius_)) return std::nullopt;
  const double stretch = 1.0 + r * r * (parameters_.k1 + parameters_.k2 * r * r);
  return parameters_.centre_px + parameters_.scale_px * stretch * q;
}

RadialParameterJacobian RadialMap::parameter_jacobian(const vision::PixelPoint& pixel) const {
  const Undistorted at = undistorted(pixel);
  const Eigen::Vector3d m = at.q.homogeneous();
  const Eigen::Vector3d image = parameters_.homography_m * m;
  const Eigen::Vector2d place_m = image.hnormalized();
  RadialParameterJacobian jacobian =
      RadialParameterJacobian::Zero(2, parameter_count(parameters_.kind));
  jacobian.block<1, 3>(0, 0) = m.transpose() / image.z();
  jacobian.block<1, 3>(1, 3) = m.transpose() / image.z();
  jacobian.block<2, 2>(0, 6) = -place_m * at.q.transpose() / image.z();
  if (parameters_.kind == ModelKind::kHomography) return jacobian;
  // d is given, so a larger k makes q shorter: 0 = slope dr + r^3 dk1 + r^5 dk2.
  const Eigen::Matrix2d projection = projection_jacobian(at.q);
  const double cubed = at.radius * at.radius * at.radius;
  const Eigen::Vector2d outward_m = projection * at.direction / at.slope;
  jacobian.col(8) = -cubed * outward_m;
  if (parameters_.kind == ModelKind::kRadial) return jacobian;
  jacobian.col(9) = -cubed * at.radius * at.radius * outward_m;
  jacobian.block<2, 2>(0, 10) = -projection * at.by_distorted;
  return jacobian;
}

Eigen::Matrix2d RadialMap::unit_covariance(const vision::PixelPoint& pixel) const {
  const RadialParameterJacobian jacobian = parameter_jacobian(pixel);
  return jacobian * parameters_.information_inverse * jacobian.transpose();
}

Eigen::MatrixX2d RadialMap::axis_basis(const vision::PixelPoint& pixel) const {
  const RadialParameterJacobian jacobian = parameter_jacobian(pixel);
  const Eigen::Index shared = jacobian.cols() - 6;  // from h20 on
  Eigen::MatrixX2d basis(3 + shared, 2);
  for (int axis = 0; axis < 2; ++axis) {
    basis.col(axis).head<3>() = jacobian.row(axis).segment<3>(3 * axis);
    basis.col(axis).tail(shared) = jacobian.row(axis).tail(shared);
  }
  return basis;
}

}  // namespace nadir::calibration
