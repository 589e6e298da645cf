#include "control_client/differential/differential_base.h"

#include <cmath>
#include <utility>

namespace nadir::control_client {

using fusion::Timestamp;
using tracker::WheelCommandKind;

DifferentialBase::DifferentialBase(const DifferentialParameters& robot,
                                   const SimulationSettings& settings, Timestamp now,
                                   SimulatedBase::TruthSink on_truth)
    : robot_(robot),
      settings_(settings),
      geometry_(fusion::WheelGeometry::differential(robot.track_m)),
      encoders_(settings.encoders, geometry_.wheels(), settings.seed),
      time_(now),
      on_truth_(std::move(on_truth)),
      pose_{settings.start.x(), settings.start.y(), fusion::wrap_angle(settings.start.z())} {}

void DifferentialBase::take_odometry(Timestamp now, std::vector<OdometryInterval>* odometry) {
  odometry->clear();
  const Timestamp step = fusion::from_seconds(settings_.step_s);
  while (time_ + step <= now) {
    advance();
    const WheelVector rims_mps =
        geometry_.rim_speeds_mps({motion_.speed_mps, 0.0, motion_.turn_rate_radps});
    odometry->push_back(
        {time_, time_ + step,
         geometry_.body_rates(encoders_.measured_rim_speeds_mps(rims_mps, settings_.step_s))});
    time_ += step;
    if (!on_truth_) continue;
    on_truth_({time_,
               pose_,
               {motion_.speed_mps * std::cos(pose_.heading_rad),
                motion_.speed_mps * std::sin(pose_.heading_rad), motion_.turn_rate_radps}});
  }
}

// Both wheels have the same lag, so the body has it too.
void DifferentialBase::advance() {
  const UnicycleMotion goal = limited(wanted(), robot_.limits);
  const double keep = std::exp(-settings_.step_s / robot_.wheel_lag_s);
  motion_.speed_mps = goal.speed_mps + keep * (motion_.speed_mps - goal.speed_mps);
  motion_.turn_rate_radps =
      goal.turn_rate_radps + keep * (motion_.turn_rate_radps - goal.turn_rate_radps);
  pose_ = moved(pose_, motion_, settings_.step_s);
}

void DifferentialBase::command(const tracker::WireWheelCommand& command, Timestamp now) {
  command_ = command;
  commanded_at_ = now;
}

std::optional<fusion::PlanarPose> DifferentialBase::truth_at(Timestamp time) const {
  return moved(pose_, motion_, fusion::to_seconds(time - time_));
}

UnicycleMotion DifferentialBase::wanted() const {
  const bool is_old =
      commanded_at_ == Timestamp(0) || time_ - commanded_at_ > Timestamp(command_.valid_for_ns);
  if (is_old || command_.kind == WheelCommandKind::kVolts) return {};
  if (command_.kind == WheelCommandKind::kBodyRates) {
    return {command_.body_rates.u_mps, command_.body_rates.r_radps};
  }
  return motion_of({command_.wheels.values[0], command_.wheels.values[1]}, robot_.track_m);
}

}  // namespace nadir::control_client
