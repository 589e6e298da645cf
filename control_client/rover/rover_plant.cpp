#include "control_client/rover/rover_plant.h"

#include <algorithm>
#include <cmath>

namespace nadir::control_client {

void RoverPlant::start(const fusion::PlanarPose& pose) {
  state_ << pose.x_m, pose.y_m, pose.heading_rad, 0.0, 0.0, 0.0;
  mean_rim_speeds_mps_.setZero();
}

fusion::PlanarPose RoverPlant::pose() const {
  return {state_[0], state_[1], fusion::wrap_angle(state_[2])};
}

RoverPlant::State RoverPlant::derivative(const State& state,
                                         const Eigen::Vector3d& wheel_forces_n) const {
  const Eigen::Matrix3d b = model_.wheel_matrix(state[2]);
  const Eigen::Vector3d rim_mps = b.transpose() * state.tail<3>();
  const Eigen::Vector3d friction_n =
      losses_.friction_n * (rim_mps / losses_.rest_mps).cwiseMax(-1.0).cwiseMin(1.0);
  State result;
  result.head<3>() = state.tail<3>();
  result.tail<3>() = (b * ((1.0 - losses_.input_loss) * wheel_forces_n - friction_n))
                         .cwiseQuotient(model_.inertia());
  return result;
}

void RoverPlant::drive(const Eigen::Vector3d& wheel_forces_n, double duration_s) {
  const int steps = std::max(1, static_cast<int>(std::ceil(duration_s / 1e-3 - 1e-9)));
  const double h = duration_s / steps;
  mean_rim_speeds_mps_.setZero();
  for (int i = 0; i < steps; ++i) {
    const State a = derivative(state_, wheel_forces_n);
    const State b = derivative(state_ + 0.5 * h * a, wheel_forces_n);
    const State c = derivative(state_ + 0.5 * h * b, wheel_forces_n);
    const State d = derivative(state_ + h * c, wheel_forces_n);
    const Eigen::Vector3d before_mps =
        model_.wheel_matrix(state_[2]).transpose() * state_.tail<3>();
    state_ += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    const Eigen::Vector3d after_mps = model_.wheel_matrix(state_[2]).transpose() * state_.tail<3>();
    mean_rim_speeds_mps_ += 0.5 * (before_mps + after_mps) / steps;
  }
}

}  // namespace nadir::control_client
