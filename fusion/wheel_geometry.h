#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "fusion/body_rates.h"

namespace nadir::fusion {

/// One driven wheel: the direction in which its rim moves the robot (unit vector in the robot's
/// frame) and its lever about the robot's centre (positive turns counter-clockwise). The rim
/// speed is direction . (u, v) + lever r.
struct Wheel {
  double direction_x = 1.0;
  double direction_y = 0.0;
  double lever_m = 0.0;
};

/// Rim speeds or travels of the wheels, m/s or m, in the order of the wheels; memory for six.
inline constexpr int kMaxWheels = 6;
using WheelValues = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxWheels, 1>;

/// Between the rim speeds s of n wheels and the body rates q of the robot: s = B^T q (S2 eq 2,
/// columns of B are the wheels) and back by least squares, q = (B B^T)^-1 B s, which for three
/// wheels is the inverse. A differential drive has no sideways rate: v is zero.
class WheelGeometry {
 public:
  /// Omnidirectional wheels, 3 to 6 of them. Throws std::invalid_argument for another number, or
  /// if a motion of the robot turns no wheel.
  static WheelGeometry omni(std::span<const Wheel> wheels);

  /// S2's robot (theory 1): wheels at 180, -60 and 60 degrees from the front, in this order, on a
  /// circle of radius `body_radius_m` > 0. B B^T is diagonal.
  static WheelGeometry three_wheel(double body_radius_m);

  /// Wheels at these angles from the front (counter-clockwise, rad), each driving along the
  /// circle of radius `body_radius_m` > 0. Throws as omni does.
  static WheelGeometry four_wheel(const Eigen::Vector4d& angles_rad, double body_radius_m);

  /// Left and right wheel `track_m` > 0 apart.
  static WheelGeometry differential(double track_m);

  int wheels() const { return static_cast<int>(rims_by_rates_.rows()); }

  WheelValues rim_speeds_mps(const BodyRates& rates) const;

  /// Least squares; `rim_speeds_mps` has one entry a wheel. Rim travels give the travel of the
  /// body in the same way.
  BodyRates body_rates(const WheelValues& rim_speeds_mps) const;

  /// Covariance of the body rates whose rim speeds have independent errors with this standard
  /// deviation (theory 3: 2/3 sigma^2 for u and v, sigma^2/(3 Lb^2) for r with three wheels).
  Eigen::Matrix3d rate_covariance(double rim_sigma_mps) const;

  /// B^T: a row for each wheel.
  using RimsByRates = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, kMaxWheels, 3>;
  const RimsByRates& rims_by_rates() const { return rims_by_rates_; }

 private:
  WheelGeometry() = default;

  RimsByRates rims_by_rates_;
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, kMaxWheels> rates_by_rims_;
};

/// Mean body rates over `dt_s` > 0 from what the wheels' encoders counted in that time, with the
/// rim's travel for one count, m. Differences of 32-bit counters that wrapped once are right.
using EncoderCounts =
    Eigen::Matrix<std::int32_t, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxWheels, 1>;
BodyRates mean_body_rates(const WheelGeometry& geometry, const EncoderCounts& from,
                          const EncoderCounts& to, double rim_m_per_count, double dt_s);

}  // namespace nadir::fusion
