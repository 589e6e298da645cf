#include "control_client/rover/rover_firmware.h"

#include <cmath>

#include "control_client/rover/rover_variant.h"
#include "fusion/odometry.h"

namespace nadir::control_client {
namespace {

VelocitySettings observing(const RoverModel& model, double bandwidth_radps) {
  VelocitySettings settings;
  settings.observer = observer_of_bandwidth(bandwidth_radps, model.parameters());
  return settings;
}

/// The same bandwidth for all axes.
VelocityGains proportional(const RoverModel& model, double bandwidth_radps) {
  return {bandwidth_radps, 0.0, 0.0, model.inertia()};
}

}  // namespace

RoverFirmware::RoverFirmware(const RoverModel& model, const RoverFirmwareSettings& settings)
    : model_(model),
      settings_(settings),
      velocity_(observing(model, settings.observer_radps), model.inertia(), settings.step_s),
      controller_(proportional(model, settings.velocity_radps), settings.step_s) {
  restart();
}

void RoverFirmware::restart() {
  pose_ = {};
  force_.setZero();
  velocity_.start(pose_);
  controller_.restart();
}

Eigen::Vector3d RoverFirmware::wheel_forces_n(const fusion::BodyRates& measured,
                                              const fusion::BodyRates& wanted) {
  velocity_.predict(force_);
  pose_ = fusion::moved(pose_, measured, settings_.step_s);
  velocity_.correct(pose_);
  const double c = std::cos(pose_.heading_rad);
  const double s = std::sin(pose_.heading_rad);
  const Eigen::Vector3d commanded(c * wanted.u_mps - s * wanted.v_mps,
                                  s * wanted.u_mps + c * wanted.v_mps, wanted.r_radps);
  // What keeps a velocity constant in the body while the body turns.
  const Eigen::Vector3d turning(-wanted.r_radps * commanded.y(), wanted.r_radps * commanded.x(),
                                0.0);
  force_ = controller_.force(commanded, velocity_.velocity(), velocity_.acceleration()) +
           model_.inertia().cwiseProduct(turning) - velocity_.disturbance();
  return model_.wheel_forces(pose_.heading_rad, force_);
}

}  // namespace nadir::control_client
