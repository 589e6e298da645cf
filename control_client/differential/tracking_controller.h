#pragma once

#include <variant>

#include "control_client/differential/tracking_gains.h"
#include "control_client/differential/unicycle.h"

namespace nadir::control_client {

/// What the motors can do, and what becomes of a command beyond it.
struct UnicycleLimits {
  double speed_mps = 0.4;
  double turn_rate_radps = 0.8;
  /// Both rates are reduced by the same factor, so that the robot stays on its arc and is late
  /// only; false: each for itself, as in S1.
  bool keeps_curvature = false;
};
UnicycleMotion limited(const UnicycleMotion& wanted, const UnicycleLimits& limits);

/// S1: v = v_r cos e3 + k1 e1, w = w_r + k2 e2 + k3 e3, with optional integrals of e1 and e2.
struct DecentralisedSettings {
  TrackingGains gains = closed_form_gains({}, 0.1);
  bool feeds_turn_rate_forward = true;  ///< false: w_r is left to the feedback
  double integral_ahead_per_s2 = 0.0;   ///< of e1 on the speed
  double integral_side = 0.0;           ///< of e2 on the turn rate, rad/(m s^2)
};

/// Klancar's nonlinear controller (2005): k1 = k3 = 2 zeta sqrt(w_r^2 + g v_r^2),
/// v = v_r cos e3 + k1 e1, w = w_r + g v_r sinc(e3) e2 + k3 e3.
struct KlancarSettings {
  double damping = 0.7;            ///< zeta
  double stiffness_per_m2 = 40.0;  ///< g
};

/// Drives a unicycle along a reference. Integrals stand while the command is beyond the limits.
class TrackingController {
 public:
  using Settings = std::variant<DecentralisedSettings, KlancarSettings>;
  TrackingController(const Settings& settings, const UnicycleLimits& limits)
      : settings_(settings), limits_(limits) {}

  /// The command for the next `period_s`, within the limits.
  UnicycleMotion command(const UnicycleReference& reference, const fusion::PlanarPose& pose,
                         double period_s);
  /// The last command was beyond the limits.
  bool saturated() const { return saturated_; }
  void reset() { integral_ = Eigen::Vector2d::Zero(); }

 private:
  UnicycleMotion wanted(const DecentralisedSettings& settings, const UnicycleReference& reference,
                        const Eigen::Vector3d& error) const;

  Settings settings_;
  UnicycleLimits limits_;
  Eigen::Vector2d integral_ = Eigen::Vector2d::Zero();  // of e1, e2; m s
  bool saturated_ = false;
};

}  // namespace nadir::control_client
