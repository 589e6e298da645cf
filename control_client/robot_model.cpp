#include "control_client/robot_model.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace nadir::control_client {
namespace {

void require_positive(double value, const char* name) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw std::invalid_argument(fmt::format("{} is {}; it must be above 0", name, value));
  }
}

void check(const RobotParameters& parameters) {
  require_positive(parameters.mass_kg, "mass_kg");
  require_positive(parameters.inertia_kg_m2, "inertia_kg_m2");
  require_positive(parameters.wheel_radius_m, "wheel_radius_m");
  require_positive(parameters.max_speed_mps, "max_speed_mps");
  require_positive(parameters.max_turn_rate_radps, "max_turn_rate_radps");
  const MotorParameters& motor = parameters.motor;
  require_positive(motor.torque_constant_nm_per_a, "torque_constant_nm_per_a");
  require_positive(motor.resistance_ohm, "resistance_ohm");
  require_positive(motor.gear_ratio, "gear_ratio");
  require_positive(motor.max_voltage_v, "max_voltage_v");
}

fusion::WheelGeometry wheel_geometry(const std::vector<WheelMount>& mounts) {
  std::vector<fusion::Wheel> wheels;
  wheels.reserve(mounts.size());
  for (const WheelMount& mount : mounts) {
    wheels.push_back({-std::sin(mount.angle_rad), std::cos(mount.angle_rad), mount.distance_m});
  }
  return fusion::WheelGeometry::omni(wheels);
}

}  // namespace

std::vector<WheelMount> RobotParameters::three_wheels(double distance_m) {
  constexpr double kPi = std::numbers::pi;
  return {{kPi, distance_m}, {-kPi / 3.0, distance_m}, {kPi / 3.0, distance_m}};
}

RobotModel::RobotModel(const RobotParameters& parameters)
    : parameters_(parameters), geometry_(wheel_geometry(parameters.wheels)) {
  check(parameters);
  const MotorParameters& motor = parameters.motor;
  const double gear_per_m = motor.gear_ratio / parameters.wheel_radius_m;
  const Eigen::Vector3d h(1.0 / parameters.mass_kg, 1.0 / parameters.mass_kg,
                          1.0 / parameters.inertia_kg_m2);
  const Eigen::Matrix3d hbb = h.asDiagonal() * drive() * drive().transpose();
  inertia_ratio_ =
      Eigen::Matrix3d::Identity() + hbb * (gear_per_m * gear_per_m * motor.rotor_inertia_kg_m2);
  inertia_ratio_inverse_ = inertia_ratio_.inverse();
  const double motor_damping =
      motor.torque_constant_nm_per_a * motor.back_emf_v_s_per_rad / motor.resistance_ohm +
      motor.friction_nm_s_per_rad;
  damping_per_s_ = inertia_ratio_inverse_ * hbb * (motor_damping * gear_per_m * gear_per_m);
  input_ = inertia_ratio_inverse_ * h.asDiagonal() * drive() *
           (motor.torque_constant_nm_per_a * gear_per_m / motor.resistance_ohm);
  // Right inverse, of least norm: the only one for three wheels.
  input_inverse_ = input_.transpose() * Eigen::Matrix3d(input_ * input_.transpose()).inverse();
}

Eigen::Vector3d RobotModel::coriolis(const Eigen::Vector3d& body_rates) const {
  return inertia_ratio_inverse_ *
         Eigen::Vector3d(body_rates.z() * body_rates.y(), -body_rates.z() * body_rates.x(), 0.0);
}

Eigen::Vector3d RobotModel::acceleration(const Eigen::Vector3d& body_rates,
                                         const WheelVector& voltages_v) const {
  return coriolis(body_rates) - damping_per_s_ * body_rates + input_ * voltages_v;
}

WheelVector RobotModel::voltages_v(const Eigen::Vector3d& body_rates,
                                   const Eigen::Vector3d& acceleration) const {
  return input_inverse_ * (acceleration - coriolis(body_rates) + damping_per_s_ * body_rates);
}

Eigen::Matrix3d RobotModel::linearization_per_s(const Eigen::Vector3d& body_rates) const {
  const double u_mps = body_rates.x();
  const double v_mps = body_rates.y();
  const double r_radps = body_rates.z();
  Eigen::Matrix3d turning;
  turning << 0.0, r_radps, v_mps, -r_radps, 0.0, -u_mps, 0.0, 0.0, 0.0;
  return inertia_ratio_inverse_ * turning - damping_per_s_;
}

}  // namespace nadir::control_client
