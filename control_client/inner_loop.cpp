#include "control_client/inner_loop.h"

namespace nadir::control_client {

InnerLoop::InnerLoop(const RobotModel& model, const LoopParameters& parameters)
    : model_(&model),
      parameters_(parameters),
      filter_(parameters.filter_damping, parameters.filter_bandwidth_radps,
              Eigen::Vector3d::Zero()) {}

WheelMatrix InnerLoop::proportional_gain(const Eigen::Vector3d& nominal_rates) const {
  return model_->input_inverse() *
         (model_->linearization_per_s(nominal_rates) +
          Eigen::Matrix3d::Identity() * parameters_.proportional_gain_per_s());
}

WheelMatrix InnerLoop::integral_gain() const {
  return model_->input_inverse() * parameters_.integral_gain_per_s2();
}

WheelVector InnerLoop::voltages_v(const Eigen::Vector3d& command,
                                  const Eigen::Vector3d& measured_rates, double dt_s) {
  filter_.step(command, dt_s);
  const Eigen::Vector3d& nominal = filter_.value();
  const Eigen::Vector3d deviation = measured_rates - nominal;
  WheelVector wanted_v = model_->voltages_v(nominal, filter_.rate_per_s());
  wanted_v -= proportional_gain(nominal) * deviation + integral_gain() * deviation_integral_;
  const double limit_v = model_->parameters().motor.max_voltage_v;
  demanded_voltage_v_ = wanted_v.cwiseAbs().maxCoeff();
  is_saturated_ = demanded_voltage_v_ > limit_v;
  if (!is_saturated_) deviation_integral_ += dt_s * deviation;
  return wanted_v.cwiseMax(-limit_v).cwiseMin(limit_v);
}

void InnerLoop::restart() {
  filter_.restart(Eigen::Vector3d::Zero());
  deviation_integral_.setZero();
  is_saturated_ = false;
}

}  // namespace nadir::control_client
