#pragma once

#include <Eigen/Core>

namespace nadir::control_client {

/// Gains of S4's PID, which are those of a body of some kilograms; the heading's inertia is sixty
/// times smaller, so all three are scaled for each axis. Unscaled, KD = -0.2 makes the heading's
/// inertia 0.025 - 0.2 kg m^2, negative (theory 10, item 33).
struct VelocityGains {
  double proportional = 8.0;
  double integral = 7.0;
  double derivative = -0.2;
  Eigen::Vector3d axis_scale{1.0, 1.0, 0.03};
};

/// The force for a velocity (world frame; x, y, heading):
///
///     u0 = KP (v_c - v) + KI sum (v_c - v) T - KD v'
class VelocityController {
 public:
  VelocityController(const VelocityGains& gains, double tick_s) : gains_(gains), tick_s_(tick_s) {}

  void restart() { sum_.setZero(); }

  Eigen::Vector3d force(const Eigen::Vector3d& commanded, const Eigen::Vector3d& velocity,
                        const Eigen::Vector3d& acceleration) {
    const Eigen::Vector3d error = commanded - velocity;
    sum_ += tick_s_ * error;
    return gains_.axis_scale.cwiseProduct(gains_.proportional * error + gains_.integral * sum_ -
                                          gains_.derivative * acceleration);
  }

 private:
  VelocityGains gains_;
  double tick_s_;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
};

}  // namespace nadir::control_client
