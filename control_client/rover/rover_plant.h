#pragma once

#include <Eigen/Core>

#include "control_client/rover/rover_model.h"
#include "fusion/planar_pose.h"

namespace nadir::control_client {

/// What is lost between commanded and acting wheel forces (S4): F = u - loss u - friction, the
/// friction against the wheel's motion. At rest it cancels the drive up to its size.
struct DriveLosses {
  double input_loss = 0.05;
  double friction_n = 0.35;
  /// Slower than this the friction is in proportion to the speed, as if at rest.
  double rest_mps = 0.002;
};

/// The simulated rover: what the controller and the observer do not know of is here.
class RoverPlant {
 public:
  RoverPlant(const RoverModel& model, const DriveLosses& losses) : model_(model), losses_(losses) {}

  /// At rest.
  void start(const fusion::PlanarPose& pose);
  /// Constant wheel forces (N) for a time, in steps of at most a millisecond (Runge and Kutta).
  void drive(const Eigen::Vector3d& wheel_forces_n, double duration_s);

  fusion::PlanarPose pose() const;
  /// Not wrapped.
  double heading_rad() const { return state_[2]; }
  /// World frame: m/s, m/s, rad/s.
  Eigen::Vector3d velocity() const { return state_.tail<3>(); }
  /// Of the wheels over the last drive.
  const Eigen::Vector3d& mean_rim_speeds_mps() const { return mean_rim_speeds_mps_; }

 private:
  using State = Eigen::Matrix<double, 6, 1>;
  State derivative(const State& state, const Eigen::Vector3d& wheel_forces_n) const;

  RoverModel model_;
  DriveLosses losses_;
  State state_ = State::Zero();
  Eigen::Vector3d mean_rim_speeds_mps_ = Eigen::Vector3d::Zero();
};

}  // namespace nadir::control_client
