#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <string>

#include "fusion/planar_pose.h"

namespace nadir::fusion {

/// Gains of an extended state observer of one axis with inertia mu (S4, theory 6), e = y - h_x:
///
///     h_x' = h_v + lx e,   h_v' = (u + h_d) / mu + lv e,   h_d' = ld e
///
/// Units for an axis of length; with kg m^2, N m and rad it is the same for a heading.
struct ObserverGains {
  double position_per_s = 0.0;             ///< lx
  double velocity_per_s2 = 0.0;            ///< lv
  double disturbance_n_per_m_per_s = 0.0;  ///< ld
};

/// All three poles at -bandwidth: lx = 3 w, lv = 3 w^2, ld = w^3 mu. Both above 0.
ObserverGains gains_of_bandwidth(double bandwidth_radps, double inertia);

/// Whether an observer with these gains forgets its errors.
struct ObserverStability {
  bool is_stable = false;
  /// lx lv - ld / mu: with lx > 0 and ld > 0 it is stable if and only if this is above 0 (Routh).
  double routh_margin_per_s3 = 0.0;
  /// Roots of s^3 + lx s^2 + lv s + ld / mu, 1/s, the one with the largest real part first.
  std::array<std::complex<double>, 3> poles;

  /// "unstable: 2 < 66.7, poles +0.29 +- 2.49j, -10.6", for people.
  std::string text() const;
};
ObserverStability observer_stability(const ObserverGains& gains, double inertia);

/// Position, velocity and the force that nobody commanded, of a body with three axes (x, y,
/// heading), from measured poses and commanded forces.
///
/// The discretization is exact: between measurements the body moves as it would under constant
/// force and disturbance, and a measurement corrects with those gains for which the errors from
/// tick to tick have the poles exp(s T) of the continuous observer's s (so unstable gains stay
/// unstable). With p(z) = z^3 + c2 z^2 + c1 z + c0 having these roots, and the correction
/// x += k1 e, v += k2 e, d += mu k3 e:
///
///     k1 = 1 + c0,   k2 = (c2 + 3 - k1 - p(1) / 2) / T,   k3 = p(1) / T^2
///
/// In bandwidth form that is k1 = 1 - z^3, k2 = 3 (1 - z)^2 (1 + z) / (2 T), k3 = (1 - z)^3 / T^2
/// with z = exp(-w T) (Miklosovic, Radke, Gao, "Discrete implementation and generalization of the
/// extended state observer", 2006).
class ExtendedStateObserver {
 public:
  /// Gains and inertias (kg, kg, kg m^2; above 0) of x, y, heading; a measurement each tick_s > 0.
  ExtendedStateObserver(const std::array<ObserverGains, 3>& gains, const Eigen::Vector3d& inertia,
                        double tick_s);

  /// At rest at a pose, undisturbed.
  void start(const PlanarPose& pose);
  /// A tick under a constant force in the world frame (N, N, N m); returns the displacement that is
  /// expected (m, m, rad).
  Eigen::Vector3d predict(const Eigen::Vector3d& force);
  void correct(const PlanarPose& measured);

  const PlanarPose& pose() const { return pose_; }
  /// In the world frame: m/s, m/s, rad/s.
  const Eigen::Vector3d& velocity() const { return velocity_; }
  /// Force in the world frame that acts beside the commanded one: N, N, N m.
  const Eigen::Vector3d& disturbance() const { return disturbance_; }

  /// Of the correction, columns x, y, heading, rows k1, k2 (1/s), mu k3 (N/m).
  const Eigen::Matrix3d& correction_gains() const { return gain_; }

 private:
  Eigen::Vector3d inertia_;
  double tick_s_;
  Eigen::Matrix3d gain_;
  PlanarPose pose_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d disturbance_ = Eigen::Vector3d::Zero();
};

}  // namespace nadir::fusion
