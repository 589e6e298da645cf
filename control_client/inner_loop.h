#pragma once

#include <Eigen/Core>

#include "control_client/control_parameters.h"
#include "control_client/pseudo_differentiator.h"
#include "control_client/robot_model.h"

namespace nadir::control_client {

/// Dynamics loop of the trajectory linearization control (S2 eq 12 to 16): the motor voltages that
/// make the body rates follow their command. The command passes a pseudo-differentiator that gives
/// q_n and q_n'; with the deviation d = measured - q_n
///
///     E   = E_n(q_n, q_n') - KP2 d - KI2 Int(d)
///     KP2 = Bu^-1 (A2(q_n) + diag(a22)),   KI2 = Bu^-1 diag(a21)
///
/// Voltages are limited to the motors' range; while one is at its limit the integral rests.
class InnerLoop {
 public:
  /// `model` outlives the loop.
  InnerLoop(const RobotModel& model, const LoopParameters& parameters);

  /// One step: the command acts for dt_s; `measured_rates` is the mean of the step before.
  WheelVector voltages_v(const Eigen::Vector3d& command, const Eigen::Vector3d& measured_rates,
                         double dt_s);
  void restart();

  /// Whether the last step met the motors' limit.
  bool is_saturated() const { return is_saturated_; }
  /// Largest voltage that the last step asked for, before the limit.
  double demanded_voltage_v() const { return demanded_voltage_v_; }
  const Eigen::Vector3d& nominal_rates() const { return filter_.value(); }

  WheelMatrix proportional_gain(const Eigen::Vector3d& nominal_rates) const;
  WheelMatrix integral_gain() const;

 private:
  const RobotModel* model_;
  LoopParameters parameters_;
  PseudoDifferentiator filter_;
  Eigen::Vector3d deviation_integral_ = Eigen::Vector3d::Zero();
  bool is_saturated_ = false;
  double demanded_voltage_v_ = 0.0;
};

}  // namespace nadir::control_client
