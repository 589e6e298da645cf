#pragma once

#include <Eigen/Core>

namespace nadir::control_client {

/// Second-order command filter that gives a smooth command and its derivative (S0 eq 4, S2 eq 7),
/// on three channels with one bandwidth, so that a path in the plane keeps its shape:
///
///     x'' = w^2 (command - x) - 2 zeta w x'
///
/// Stepped exactly for a command that is constant over the step, whatever w dt is. A ramp is
/// followed 2 zeta / w late. A heading command must be unwrapped.
class PseudoDifferentiator {
 public:
  /// 0 < damping < 1, bandwidth_radps > 0.
  PseudoDifferentiator(double damping, double bandwidth_radps, const Eigen::Vector3d& start);

  /// `command` acts for dt_s > 0 from now on.
  void step(const Eigen::Vector3d& command, double dt_s);
  void restart(const Eigen::Vector3d& start);

  const Eigen::Vector3d& value() const { return value_; }
  const Eigen::Vector3d& rate_per_s() const { return rate_per_s_; }
  /// x'' under `command`, per s^2.
  Eigen::Vector3d acceleration_per_s2(const Eigen::Vector3d& command) const;
  double ramp_lag_s() const { return 2.0 * damping_ / bandwidth_radps_; }

 private:
  double damping_;
  double bandwidth_radps_;
  Eigen::Vector3d value_;
  Eigen::Vector3d rate_per_s_ = Eigen::Vector3d::Zero();
};

/// The same filter with a bandwidth that moves (time-varying pseudo-differentiator, S2 5.2). For
/// the moving eigenvalues (-zeta +- j sqrt(1 - zeta^2)) w(t) the assignment of the PD-spectrum asks
/// for
///
///     x'' = w^2 (command - x) - (2 zeta w - w'/w) x'
///
/// Integrated with the fourth-order Runge-Kutta rule.
class VaryingPseudoDifferentiator {
 public:
  VaryingPseudoDifferentiator(double damping, double bandwidth_radps, const Eigen::Vector3d& start);

  /// The bandwidth moves at bandwidth_rate_radps2 during the step, linearly.
  void step(const Eigen::Vector3d& command, double bandwidth_rate_radps2, double dt_s);

  double damping() const { return damping_; }
  double bandwidth_radps() const { return bandwidth_radps_; }
  void set_bandwidth_radps(double bandwidth_radps) { bandwidth_radps_ = bandwidth_radps; }
  const Eigen::Vector3d& value() const { return value_; }
  const Eigen::Vector3d& rate_per_s() const { return rate_per_s_; }

 private:
  double damping_;
  double bandwidth_radps_;
  Eigen::Vector3d value_;
  Eigen::Vector3d rate_per_s_ = Eigen::Vector3d::Zero();
};

}  // namespace nadir::control_client
