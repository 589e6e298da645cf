#include "control_client/rover/rover_base.h"

#include <numbers>
#include <utility>

namespace nadir::control_client {

using fusion::Timestamp;
using tracker::WheelCommandKind;

RobotParameters rover_description(const RoverParameters& rover) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  RobotParameters robot;
  robot.name = "rover";
  robot.mass_kg = rover.mass_kg;
  robot.inertia_kg_m2 = rover.inertia_kgm2;
  // Wheel 1 drives along -x (the columns of Bw at heading 0).
  robot.wheels = {{90.0 * kDegree, rover.arm_m},
                  {-150.0 * kDegree, rover.arm_m},
                  {-30.0 * kDegree, rover.arm_m}};
  constexpr double kMoreThanEnough_v = 1000.0;
  robot.motor.max_voltage_v = kMoreThanEnough_v;
  return robot;
}

RoverBase::RoverBase(const RoverRobot& rover, const SimulationSettings& settings, Timestamp now,
                     SimulatedBase::TruthSink on_truth)
    : settings_(settings),
      geometry_(RobotModel(rover_description(rover.body)).geometry()),
      plant_(RoverModel(rover.body), rover.losses),
      firmware_(RoverModel(rover.body),
                {settings.step_s, rover.firmware.observer_radps, rover.firmware.velocity_radps}),
      encoders_(settings.encoders, geometry_.wheels(), settings.seed),
      time_(now),
      on_truth_(std::move(on_truth)) {
  plant_.start({settings.start.x(), settings.start.y(), settings.start.z()});
}

void RoverBase::take_odometry(Timestamp now, std::vector<OdometryInterval>* odometry) {
  odometry->clear();
  const Timestamp step = fusion::from_seconds(settings_.step_s);
  while (time_ + step <= now) {
    plant_.drive(wheel_forces_n(), settings_.step_s);
    measured_ = geometry_.body_rates(
        encoders_.measured_rim_speeds_mps(plant_.mean_rim_speeds_mps(), settings_.step_s));
    odometry->push_back({time_, time_ + step, measured_});
    time_ += step;
    if (on_truth_) on_truth_({time_, plant_.pose(), plant_.velocity()});
  }
}

void RoverBase::command(const tracker::WireWheelCommand& command, Timestamp now) {
  command_ = command;
  commanded_at_ = now;
}

std::optional<fusion::PlanarPose> RoverBase::truth_at(Timestamp time) const {
  const Eigen::Vector3d way = fusion::to_seconds(time - time_) * plant_.velocity();
  const fusion::PlanarPose pose = plant_.pose();
  return fusion::PlanarPose{pose.x_m + way.x(), pose.y_m + way.y(),
                            fusion::wrap_angle(pose.heading_rad + way.z())};
}

Eigen::Vector3d RoverBase::wheel_forces_n() {
  stopped_itself_ =
      commanded_at_ == Timestamp(0) || time_ - commanded_at_ > Timestamp(command_.valid_for_ns);
  if (stopped_itself_ || command_.kind == WheelCommandKind::kVolts) {
    firmware_.restart();
    return Eigen::Vector3d::Zero();
  }
  return firmware_.wheel_forces_n(measured_, wanted_rates());
}

fusion::BodyRates RoverBase::wanted_rates() const {
  if (command_.kind == WheelCommandKind::kBodyRates) {
    return {command_.body_rates.u_mps, command_.body_rates.v_mps, command_.body_rates.r_radps};
  }
  WheelVector rims(geometry_.wheels());
  for (int i = 0; i < rims.size(); ++i) {
    rims(i) = command_.wheels.values.at(static_cast<std::size_t>(i));
  }
  return geometry_.body_rates(rims);
}

}  // namespace nadir::control_client
