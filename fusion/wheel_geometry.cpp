#include "fusion/wheel_geometry.h"

#include <Eigen/LU>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace nadir::fusion {
namespace {

Wheel wheel_on_circle(double angle_rad, double radius_m) {
  return {-std::sin(angle_rad), std::cos(angle_rad), radius_m};
}

}  // namespace

WheelGeometry WheelGeometry::omni(std::span<const Wheel> wheels) {
  const auto count = static_cast<Eigen::Index>(wheels.size());
  if (count < 3 || count > kMaxWheels) {
    throw std::invalid_argument("an omnidirectional robot has 3 to 6 wheels");
  }
  WheelGeometry geometry;
  geometry.rims_by_rates_.resize(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Wheel& wheel = wheels[static_cast<std::size_t>(i)];
    geometry.rims_by_rates_.row(i) << wheel.direction_x, wheel.direction_y, wheel.lever_m;
  }
  const Eigen::Matrix3d b_b_transposed =
      geometry.rims_by_rates_.transpose() * geometry.rims_by_rates_;
  Eigen::FullPivLU<Eigen::Matrix3d> lu(b_b_transposed);
  lu.setThreshold(1e-9);
  if (!lu.isInvertible()) {
    throw std::invalid_argument("a motion of the robot turns none of these wheels");
  }
  geometry.rates_by_rims_ = lu.inverse() * geometry.rims_by_rates_.transpose();
  return geometry;
}

WheelGeometry WheelGeometry::three_wheel(double body_radius_m) {
  // B of S2: columns (0, -1, Lb), (cos 30, sin 30, Lb), (-cos 30, sin 30, Lb). Its B B^T is
  // diag(3/2, 3/2, 3 Lb^2), so no matrix has to be inverted.
  const double cos30 = std::sqrt(0.75);
  WheelGeometry geometry;
  geometry.rims_by_rates_.resize(3, 3);
  geometry.rims_by_rates_ << 0.0, -1.0, body_radius_m,  //
      cos30, 0.5, body_radius_m,                        //
      -cos30, 0.5, body_radius_m;
  const Eigen::Vector3d inverse_diagonal(2.0 / 3.0, 2.0 / 3.0,
                                         1.0 / (3.0 * body_radius_m * body_radius_m));
  geometry.rates_by_rims_ = inverse_diagonal.asDiagonal() * geometry.rims_by_rates_.transpose();
  return geometry;
}

WheelGeometry WheelGeometry::four_wheel(const Eigen::Vector4d& angles_rad, double body_radius_m) {
  std::array<Wheel, 4> wheels;
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    wheels[i] = wheel_on_circle(angles_rad[static_cast<Eigen::Index>(i)], body_radius_m);
  }
  return omni(wheels);
}

WheelGeometry WheelGeometry::differential(double track_m) {
  WheelGeometry geometry;
  geometry.rims_by_rates_.resize(2, 3);
  geometry.rims_by_rates_ << 1.0, 0.0, -0.5 * track_m,  //
      1.0, 0.0, 0.5 * track_m;
  geometry.rates_by_rims_.resize(3, 2);
  geometry.rates_by_rims_ << 0.5, 0.5,  //
      0.0, 0.0,                         //
      -1.0 / track_m, 1.0 / track_m;
  return geometry;
}

WheelValues WheelGeometry::rim_speeds_mps(const BodyRates& rates) const {
  return rims_by_rates_ * rates.vector();
}

BodyRates WheelGeometry::body_rates(const WheelValues& rim_speeds_mps) const {
  assert(rim_speeds_mps.size() == wheels());
  return BodyRates::from(rates_by_rims_ * rim_speeds_mps);
}

Eigen::Matrix3d WheelGeometry::rate_covariance(double rim_sigma_mps) const {
  return rim_sigma_mps * rim_sigma_mps * rates_by_rims_ * rates_by_rims_.transpose();
}

BodyRates mean_body_rates(const WheelGeometry& geometry, const EncoderCounts& from,
                          const EncoderCounts& to, double rim_m_per_count, double dt_s) {
  assert(from.size() == geometry.wheels() && to.size() == from.size() && dt_s > 0.0);
  WheelValues rim_speeds_mps(from.size());
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    // Unsigned arithmetic wraps as the counters do.
    const auto counted = static_cast<std::int32_t>(static_cast<std::uint32_t>(to[i]) -
                                                   static_cast<std::uint32_t>(from[i]));
    rim_speeds_mps[i] = rim_m_per_count * counted / dt_s;
  }
  return geometry.body_rates(rim_speeds_mps);
}

}  // namespace nadir::fusion
