#pragma once

#include <Eigen/Core>

#include "control_client/control_parameters.h"
#include "control_client/nominal_motion.h"
#include "fusion/planar_pose.h"

namespace nadir::control_client {

/// Kinematic loop of the trajectory linearization control (S2 eq 6 to 11): the body rates that lead
/// the robot's pose back to the nominal one. With e = pose - nominal, heading wrapped,
///
///     q_com = q_n - KP1 e - KI1 Int(e)
///     KP1   = R(psi_n)^T diag(a12) + [0 0 -v_n; 0 0 u_n; 0 0 0],   KI1 = R(psi_n)^T diag(a11)
///
/// gives each channel the poles of s^2 + a12 s + a11, wherever the nominal is and however it moves.
class OuterLoop {
 public:
  explicit OuterLoop(const LoopParameters& parameters) : parameters_(parameters) {}

  /// dt_s after the tick before. The error counts for that time in the integral, which the rates
  /// then use; with `integrate` false the integral keeps its value (saturated motors).
  Eigen::Vector3d body_rate_command(const NominalMotion& nominal, const fusion::PlanarPose& pose,
                                    double dt_s, bool integrate = true);
  void restart() { error_integral_.setZero(); }

  /// KP1 and KI1 at a nominal motion.
  Eigen::Matrix3d proportional_gain(const NominalMotion& nominal) const;
  Eigen::Matrix3d integral_gain(const NominalMotion& nominal) const;

 private:
  LoopParameters parameters_;
  Eigen::Vector3d error_integral_ = Eigen::Vector3d::Zero();  ///< m s, m s, rad s
};

}  // namespace nadir::control_client
