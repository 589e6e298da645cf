#include "control_client/control_loop.h"

#include <cassert>
#include <utility>

namespace nadir::control_client {

ControlLoop::ControlLoop(const RobotModel& model, const ControlParameters& control)
    : control_(control),
      command_limit_(model.parameters().max_speed_mps, model.parameters().max_speed_mps,
                     model.parameters().max_turn_rate_radps),
      outer_(control.outer),
      inner_(model, control.inner) {}

ControlLoop::ControlLoop(const RobotModel& model, const ControlParameters& control,
                         const NominalSettings& nominal, TrajectoryPtr trajectory)
    : ControlLoop(model, control) {
  nominal_.emplace(model, control, nominal, std::move(trajectory));
  motion_ = nominal_->motion();
}

const Eigen::Vector3d& ControlLoop::tick(const fusion::PlanarPose& estimate) {
  assert(nominal_);
  if (has_started_) nominal_->advance();
  has_started_ = true;
  return tick(estimate, nominal_->motion(), control_.tick_s);
}

const Eigen::Vector3d& ControlLoop::tick(const fusion::PlanarPose& estimate,
                                         const NominalMotion& nominal, double dt_s) {
  motion_ = nominal;
  return tick_at(outer_.body_rate_command(motion_, estimate, dt_s, !is_saturated_));
}

const Eigen::Vector3d& ControlLoop::tick_at(const Eigen::Vector3d& body_rates) {
  command_ = body_rates.cwiseMax(-command_limit_).cwiseMin(command_limit_);
  is_saturated_ = false;
  return command_;
}

WheelVector ControlLoop::inner_step(const Eigen::Vector3d& measured_rates) {
  return inner_step(measured_rates, control_.inner_step_s());
}

WheelVector ControlLoop::inner_step(const Eigen::Vector3d& measured_rates, double dt_s) {
  WheelVector voltages_v = inner_.voltages_v(command_, measured_rates, dt_s);
  is_saturated_ = is_saturated_ || inner_.is_saturated();
  return voltages_v;
}

}  // namespace nadir::control_client
