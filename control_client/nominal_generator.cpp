#include "control_client/nominal_generator.h"

namespace nadir::control_client {

NominalGenerator::NominalGenerator(const RobotModel& model, const ControlParameters& control,
                                   const NominalSettings& settings, TrajectoryPtr trajectory)
    : settings_(settings),
      trajectory_(std::move(trajectory)),
      tick_s_(control.tick_s),
      filter_(control.outer.filter_damping, control.outer.filter_bandwidth_radps,
              trajectory_->at(0.0).pose) {
  const TrajectoryPoint start = trajectory_->at(0.0);
  if (settings.kind == NominalKind::kShaped) {
    const Eigen::Vector3d first_command = trajectory_->at(tick_s_ + settings.preview_s).pose;
    shaping_.emplace(model, settings.shaping, start.pose, first_command);
  }
  motion_.pose = start.pose;
  if (settings.kind == NominalKind::kExact) motion_.velocity_per_s = start.velocity_per_s;
}

void NominalGenerator::advance(double dt_s, double pace) {
  if (dt_s == tick_s_ && pace == 1.0) {
    ++ticks_;
  } else {
    began_s_ = time_s() + pace * dt_s;
    ticks_ = 0;
  }
  const TrajectoryPoint command = trajectory_->at(time_s() + settings_.preview_s);
  if (settings_.kind == NominalKind::kExact) {
    motion_ = {command.pose, pace * command.velocity_per_s};
  } else if (shaping_) {
    shaping_->step(command.pose, dt_s);
    motion_ = shaping_->motion();
  } else {
    filter_.step(command.pose, dt_s);
    motion_ = {filter_.value(), filter_.rate_per_s()};
  }
}

}  // namespace nadir::control_client
