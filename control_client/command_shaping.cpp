#include "control_client/command_shaping.h"

#include <algorithm>
#include <cmath>

namespace nadir::control_client {

CommandShaping::CommandShaping(const RobotModel& model, const ShapingParameters& parameters,
                               const Eigen::Vector3d& start, const Eigen::Vector3d& first_command)
    : model_(&model),
      parameters_(parameters),
      filter_(parameters.damping, parameters.max_bandwidth_radps, start) {
  filter_.set_bandwidth_radps(target_bandwidth_radps(first_command));
}

// p'' = w^2 (command - p) - 2 zeta w p',  q' = R^T p'' + [r v, -r u, 0]^T,  E by S2 eq 12.
double CommandShaping::nominal_voltage_v(const Eigen::Vector3d& command,
                                         double bandwidth_radps) const {
  const NominalMotion nominal = motion();
  const Eigen::Vector3d acceleration_world =
      bandwidth_radps * bandwidth_radps * (command - nominal.pose) -
      2.0 * parameters_.damping * bandwidth_radps * nominal.velocity_per_s;
  const Eigen::Vector3d rates = nominal.body_rates();
  const Eigen::Vector3d acceleration =
      rotation_world_body(nominal.pose.z()).transpose() * acceleration_world +
      Eigen::Vector3d(rates.z() * rates.y(), -rates.z() * rates.x(), 0.0);
  return model_->voltages_v(rates, acceleration).cwiseAbs().maxCoeff();
}

double CommandShaping::target_bandwidth_radps(const Eigen::Vector3d& command) const {
  const double allowed_v = parameters_.voltage_share * model_->parameters().motor.max_voltage_v;
  double bandwidth = parameters_.max_bandwidth_radps;
  while (bandwidth > parameters_.min_bandwidth_radps &&
         nominal_voltage_v(command, bandwidth) > allowed_v) {
    bandwidth *= parameters_.grid_ratio;
  }
  return std::max(bandwidth, parameters_.min_bandwidth_radps);
}

void CommandShaping::step(const Eigen::Vector3d& command, double dt_s) {
  const double target = target_bandwidth_radps(command);
  const int steps = std::max(1, static_cast<int>(std::lround(dt_s / parameters_.step_s)));
  for (int i = 0; i < steps; ++i) {
    const double rate = std::min((target - filter_.bandwidth_radps()) / parameters_.time_constant_s,
                                 parameters_.max_rise_radps2);
    filter_.step(command, rate, dt_s / steps);
  }
}

}  // namespace nadir::control_client
