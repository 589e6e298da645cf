#include "control_client/pseudo_differentiator.h"

#include <cassert>
#include <cmath>

namespace nadir::control_client {

PseudoDifferentiator::PseudoDifferentiator(double damping, double bandwidth_radps,
                                           const Eigen::Vector3d& start)
    : damping_(damping), bandwidth_radps_(bandwidth_radps), value_(start) {
  assert(damping > 0.0 && damping < 1.0 && bandwidth_radps > 0.0);
}

// wd = w sqrt(1 - zeta^2), e = exp(-zeta w dt), C = cos(wd dt), S = sin(wd dt):
//     a11 = e (C + zeta w/wd S)   a12 = e S/wd
//     a21 = -w^2 a12              a22 = e (C - zeta w/wd S)
//     x+  = a11 x + a12 x' + (1 - a11) command,   x'+ = a21 x + a22 x' - a21 command
void PseudoDifferentiator::step(const Eigen::Vector3d& command, double dt_s) {
  const double w = bandwidth_radps_;
  const double wd = w * std::sqrt(1.0 - damping_ * damping_);
  const double decay = std::exp(-damping_ * w * dt_s);
  const double c = decay * std::cos(wd * dt_s);
  const double s = decay * std::sin(wd * dt_s);
  const double a11 = c + damping_ * w / wd * s;
  const double a12 = s / wd;
  const double a21 = -w * w * a12;
  const double a22 = c - damping_ * w / wd * s;
  const Eigen::Vector3d value = a11 * value_ + a12 * rate_per_s_ + (1.0 - a11) * command;
  rate_per_s_ = a21 * (value_ - command) + a22 * rate_per_s_;
  value_ = value;
}

void PseudoDifferentiator::restart(const Eigen::Vector3d& start) {
  value_ = start;
  rate_per_s_.setZero();
}

Eigen::Vector3d PseudoDifferentiator::acceleration_per_s2(const Eigen::Vector3d& command) const {
  return bandwidth_radps_ * bandwidth_radps_ * (command - value_) -
         2.0 * damping_ * bandwidth_radps_ * rate_per_s_;
}

VaryingPseudoDifferentiator::VaryingPseudoDifferentiator(double damping, double bandwidth_radps,
                                                         const Eigen::Vector3d& start)
    : damping_(damping), bandwidth_radps_(bandwidth_radps), value_(start) {
  assert(damping > 0.0 && damping < 1.0 && bandwidth_radps > 0.0);
}

void VaryingPseudoDifferentiator::step(const Eigen::Vector3d& command, double bandwidth_rate_radps2,
                                       double dt_s) {
  const auto acceleration = [&](double after_s, const Eigen::Vector3d& value,
                                const Eigen::Vector3d& rate) -> Eigen::Vector3d {
    const double w = bandwidth_radps_ + bandwidth_rate_radps2 * after_s;
    return w * w * (command - value) - (2.0 * damping_ * w - bandwidth_rate_radps2 / w) * rate;
  };
  const double half_s = 0.5 * dt_s;
  const Eigen::Vector3d v1 = rate_per_s_;
  const Eigen::Vector3d a1 = acceleration(0.0, value_, v1);
  const Eigen::Vector3d v2 = rate_per_s_ + half_s * a1;
  const Eigen::Vector3d a2 = acceleration(half_s, value_ + half_s * v1, v2);
  const Eigen::Vector3d v3 = rate_per_s_ + half_s * a2;
  const Eigen::Vector3d a3 = acceleration(half_s, value_ + half_s * v2, v3);
  const Eigen::Vector3d v4 = rate_per_s_ + dt_s * a3;
  const Eigen::Vector3d a4 = acceleration(dt_s, value_ + dt_s * v3, v4);
  value_ += dt_s / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
  rate_per_s_ += dt_s / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  bandwidth_radps_ += bandwidth_rate_radps2 * dt_s;
  assert(bandwidth_radps_ > 0.0);
}

}  // namespace nadir::control_client
