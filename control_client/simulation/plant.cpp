#include "control_client/simulation/plant.h"

#include <algorithm>
#include <cmath>

#include "control_client/nominal_motion.h"

namespace nadir::control_client {
namespace {

struct Derivative {
  Eigen::Vector3d pose;
  Eigen::Vector3d rates;
};

}  // namespace

Plant::Plant(const RobotModel& model, const Eigen::Vector3d& start)
    : model_(&model), pose_(start), mean_rim_speeds_mps_(WheelVector::Zero(model.wheel_count())) {}

void Plant::advance(const WheelVector& voltages_v, double dt_s, const Disturbance& disturbance) {
  const auto derivative = [&](const Eigen::Vector3d& pose, const Eigen::Vector3d& rates) {
    const Eigen::Matrix3d rotation = rotation_world_body(pose.z());
    Derivative result{rotation * rates, model_->acceleration(rates, voltages_v)};
    result.rates.head<2>() +=
        rotation.topLeftCorner<2, 2>().transpose() * disturbance.acceleration_world_mps2;
    result.pose.head<2>() += disturbance.creep_world_mps;
    return result;
  };
  const int steps = std::max(1, static_cast<int>(std::lround(dt_s / kStep_s)));
  const double h = dt_s / steps;
  Eigen::Vector3d rates_integral = Eigen::Vector3d::Zero();
  for (int i = 0; i < steps; ++i) {
    const Derivative k1 = derivative(pose_, body_rates_);
    const Derivative k2 = derivative(pose_ + 0.5 * h * k1.pose, body_rates_ + 0.5 * h * k1.rates);
    const Derivative k3 = derivative(pose_ + 0.5 * h * k2.pose, body_rates_ + 0.5 * h * k2.rates);
    const Derivative k4 = derivative(pose_ + h * k3.pose, body_rates_ + h * k3.rates);
    // The rates at the stages, weighted as the pose is: the rule's own integral of the rates.
    rates_integral += h * (body_rates_ + h / 6.0 * (k1.rates + k2.rates + k3.rates));
    pose_ += h / 6.0 * (k1.pose + 2.0 * k2.pose + 2.0 * k3.pose + k4.pose);
    body_rates_ += h / 6.0 * (k1.rates + 2.0 * k2.rates + 2.0 * k3.rates + k4.rates);
  }
  mean_rim_speeds_mps_ =
      model_->geometry().rim_speeds_mps(fusion::BodyRates::from(rates_integral / dt_s));
}

}  // namespace nadir::control_client
