#pragma once

#include <Eigen/Core>
#include <optional>

#include "control_client/inner_loop.h"
#include "control_client/nominal_generator.h"
#include "control_client/outer_loop.h"
#include "fusion/planar_pose.h"

namespace nadir::control_client {

/// The whole controller of one robot: commanded trajectory -> nominal motion -> outer loop -> body
/// rates -> inner loop -> voltages. The caller owns time, estimate and motors:
///
///     each tick:        rates = loop.tick(estimated pose);
///     inner_steps each: voltages = loop.inner_step(measured body rates);
///
/// Robots whose firmware closes the inner loop take the body rates, or the rim speeds that
/// RobotModel::geometry makes of them, and leave inner_step alone.
class ControlLoop {
 public:
  /// `model` outlives the loop.
  ControlLoop(const RobotModel& model, const ControlParameters& control,
              const NominalSettings& nominal, TrajectoryPtr trajectory);

  /// Without a trajectory: the caller says at each tick where the robot is meant to be.
  ControlLoop(const RobotModel& model, const ControlParameters& control);

  /// The outer loop at the next tick; the first call is at time 0. Returns the body rates to drive
  /// at until the next tick, within the robot's limits (u, v in m/s, r in rad/s).
  const Eigen::Vector3d& tick(const fusion::PlanarPose& estimate);

  /// The same along a nominal motion of the caller's, dt_s > 0 after the tick before.
  const Eigen::Vector3d& tick(const fusion::PlanarPose& estimate, const NominalMotion& nominal,
                              double dt_s);

  /// The same with body rates that another controller asks for; nominal() stays as it is.
  const Eigen::Vector3d& tick_at(const Eigen::Vector3d& body_rates);

  /// The inner loop over the next inner step, with the mean body rates of the last.
  WheelVector inner_step(const Eigen::Vector3d& measured_rates);
  /// The same where the step takes dt_s > 0 instead of an inner step.
  WheelVector inner_step(const Eigen::Vector3d& measured_rates, double dt_s);

  /// Forgets the outer loop's integral: the robot begins another motion.
  void restart_outer() { outer_.restart(); }
  /// Forgets what the inner loop did: the motors were switched off.
  void restart_inner() { inner_.restart(); }

  const NominalMotion& nominal() const { return motion_; }
  const Eigen::Vector3d& command() const { return command_; }
  /// Of the trajectory that was given at construction; 0 without one.
  double time_s() const { return nominal_ ? nominal_->time_s() : 0.0; }
  /// Whether the motors were at their limit in the inner steps since the last tick.
  bool is_saturated() const { return is_saturated_; }
  double demanded_voltage_v() const { return inner_.demanded_voltage_v(); }

 private:
  ControlParameters control_;
  Eigen::Vector3d command_limit_;
  std::optional<NominalGenerator> nominal_;
  NominalMotion motion_;
  OuterLoop outer_;
  InnerLoop inner_;
  Eigen::Vector3d command_ = Eigen::Vector3d::Zero();
  bool has_started_ = false;
  bool is_saturated_ = false;
};

}  // namespace nadir::control_client
