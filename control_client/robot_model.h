#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fusion/wheel_geometry.h"

namespace nadir::control_client {

/// One number a wheel: voltages in V or rim speeds in m/s.
using WheelVector = fusion::WheelValues;
/// Columns are wheels, rows are force along body x, force along body y and moment.
using DriveMatrix =
    Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, fusion::kMaxWheels>;
/// From body axes to wheels.
using WheelMatrix = fusion::WheelGeometry::RimsByRates;

/// Where an omnidirectional wheel stands. It drives along the tangent, counter-clockwise.
struct WheelMount {
  double angle_rad = 0.0;   ///< of the wheel's place, from the body's x axis
  double distance_m = 0.0;  ///< from the centre of gravity, above 0
};

/// A wheel's motor with its gear; the inductance is neglected (S2 eq 3).
struct MotorParameters {
  double torque_constant_nm_per_a = 6.92e-3;  ///< k2
  double back_emf_v_s_per_rad = 6.92e-3;      ///< k3
  double resistance_ohm = 1.94;               ///< Ra
  double rotor_inertia_kg_m2 = 5.7e-7;        ///< J0
  double friction_nm_s_per_rad = 7.70e-6;     ///< b0
  double gear_ratio = 14.0;                   ///< n, motor turns a wheel turn
  double max_voltage_v = 6.0;
  int encoder_counts_per_wheel_turn = 512 * 14;
};

/// What there is to know about an omnidirectional robot. The default is the three-wheel robot of
/// data/robots/omni3.yaml, whose limits are those that S2 publishes.
struct RobotParameters {
  std::string name = "omni3";
  double mass_kg = 2.0;
  double inertia_kg_m2 = 0.008;  ///< about the vertical axis
  double wheel_radius_m = 0.025;
  std::vector<WheelMount> wheels = three_wheels(0.070);
  MotorParameters motor;
  double max_speed_mps = 1.18;         ///< of a commanded u or v
  double max_turn_rate_radps = 16.86;  ///< of a commanded r

  /// Wheel 1 at the rear, 2 at the right front, 3 at the left front (S2 fig. 1, delta = 30 deg).
  static std::vector<WheelMount> three_wheels(double distance_m);
};

/// Dynamics of the robot with its motors. Body rates are q = (u m/s, v m/s, r rad/s):
///
///     q' = G^-1 [r v, -r u, 0]^T - D q + Bu E                  (S2 eq 4)
///     G  = I + H B B^T n^2 J0 / Rw^2,   H = diag(1/m, 1/m, 1/Iz)
///     D  = G^-1 H B B^T (k2 k3 / Ra + b0) n^2 / Rw^2
///     Bu = G^-1 H B k2 n / (Rw Ra)
class RobotModel {
 public:
  /// Throws std::invalid_argument, in words for a person, if a number is out of range or the wheels
  /// cannot drive the body in all three directions.
  explicit RobotModel(const RobotParameters& parameters);

  const RobotParameters& parameters() const { return parameters_; }
  const fusion::WheelGeometry& geometry() const { return geometry_; }
  int wheel_count() const { return geometry_.wheels(); }
  DriveMatrix drive() const { return geometry_.rims_by_rates().transpose(); }  ///< B
  const Eigen::Matrix3d& inertia_ratio() const { return inertia_ratio_; }      ///< G
  const Eigen::Matrix3d& damping_per_s() const { return damping_per_s_; }      ///< D
  const DriveMatrix& input() const { return input_; }                          ///< Bu
  const WheelMatrix& input_inverse() const { return input_inverse_; }  ///< of least voltage norm

  /// q' (S2 eq 4).
  Eigen::Vector3d acceleration(const Eigen::Vector3d& body_rates,
                               const WheelVector& voltages_v) const;
  /// The voltages that give q' at q: E = Bu^-1 (q' - G^-1 [r v, -r u, 0]^T + D q) (S2 eq 12).
  WheelVector voltages_v(const Eigen::Vector3d& body_rates,
                         const Eigen::Vector3d& acceleration) const;
  /// Derivative of q' by q (A2 of S2 eq 13).
  Eigen::Matrix3d linearization_per_s(const Eigen::Vector3d& body_rates) const;

 private:
  Eigen::Vector3d coriolis(const Eigen::Vector3d& body_rates) const;

  RobotParameters parameters_;
  fusion::WheelGeometry geometry_;
  Eigen::Matrix3d inertia_ratio_;
  Eigen::Matrix3d inertia_ratio_inverse_;
  Eigen::Matrix3d damping_per_s_;
  DriveMatrix input_;
  WheelMatrix input_inverse_;
};

}  // namespace nadir::control_client
