#include "control_client/drive/simulated_base.h"

#include <utility>

#include "control_client/nominal_motion.h"
#include "fusion/odometry.h"

namespace nadir::control_client {

using fusion::Timestamp;
using tracker::WheelCommandKind;

SimulatedBase::SimulatedBase(const RobotModel& model, const LoopParameters& firmware,
                             const SimulationSettings& settings, Timestamp now, TruthSink on_truth)
    : model_(&model),
      settings_(settings),
      plant_(model, settings.start),
      encoders_(settings.encoders, model.wheel_count(), settings.seed),
      firmware_(model, firmware),
      time_(now),
      on_truth_(std::move(on_truth)) {}

void SimulatedBase::take_odometry(Timestamp now, std::vector<OdometryInterval>* odometry) {
  odometry->clear();
  const Timestamp step = fusion::from_seconds(settings_.step_s);
  while (time_ + step <= now) {
    plant_.advance(voltages_v(time_), settings_.step_s);
    measured_rates_ = model_->geometry()
                          .body_rates(encoders_.measured_rim_speeds_mps(
                              plant_.mean_rim_speeds_mps(), settings_.step_s))
                          .vector();
    odometry->push_back({time_, time_ + step, fusion::BodyRates::from(measured_rates_)});
    time_ += step;
    if (!on_truth_) continue;
    const fusion::PlanarPose pose = plant_.pose_world_robot();
    on_truth_({time_, pose, rotation_world_body(pose.heading_rad) * plant_.body_rates()});
  }
}

std::optional<fusion::PlanarPose> SimulatedBase::truth_at(Timestamp time) const {
  return fusion::moved(plant_.pose_world_robot(), fusion::BodyRates::from(plant_.body_rates()),
                       fusion::to_seconds(time - time_));
}

void SimulatedBase::command(const tracker::WireWheelCommand& command, Timestamp now) {
  command_ = command;
  commanded_at_ = now;
}

WheelVector SimulatedBase::voltages_v(Timestamp time) {
  stopped_itself_ =
      commanded_at_ == Timestamp(0) || time - commanded_at_ > Timestamp(command_.valid_for_ns);
  WheelVector volts = WheelVector::Zero(model_->wheel_count());
  if (stopped_itself_) {
    firmware_.restart();
    return volts;
  }
  if (command_.kind != WheelCommandKind::kVolts) {
    return firmware_.voltages_v(wanted_rates(), measured_rates_, settings_.step_s);
  }
  const double limit_v = model_->parameters().motor.max_voltage_v;
  for (int i = 0; i < volts.size(); ++i) {
    volts(i) = command_.wheels.values.at(static_cast<std::size_t>(i));
  }
  return volts.cwiseMax(-limit_v).cwiseMin(limit_v);
}

Eigen::Vector3d SimulatedBase::wanted_rates() const {
  if (command_.kind == WheelCommandKind::kBodyRates) {
    return {command_.body_rates.u_mps, command_.body_rates.v_mps, command_.body_rates.r_radps};
  }
  WheelVector rims(model_->wheel_count());
  for (int i = 0; i < rims.size(); ++i) {
    rims(i) = command_.wheels.values.at(static_cast<std::size_t>(i));
  }
  return model_->geometry().body_rates(rims).vector();
}

}  // namespace nadir::control_client
