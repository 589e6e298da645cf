#pragma once

#include <Eigen/Core>

#include "control_client/robot_model.h"
#include "fusion/planar_pose.h"

namespace nadir::control_client {

/// What pulls at the robot besides its motors.
struct Disturbance {
  Eigen::Vector2d acceleration_world_mps2 = Eigen::Vector2d::Zero();
  /// The body slides over the floor while the wheels keep their speed: no encoder sees it.
  Eigen::Vector2d creep_world_mps = Eigen::Vector2d::Zero();
};

/// The simulated robot: body with motors, wheels that roll without slip (what slips is what the
/// encoders report, simulation/encoders.h). Integrates
///
///     p' = R(psi) q + creep,   q' = G^-1 [r v, -r u, 0]^T - D q + Bu E + R(psi)^T acceleration
///
/// with the fourth-order Runge-Kutta rule in steps of 1 ms.
class Plant {
 public:
  static constexpr double kStep_s = 0.001;

  /// `model` outlives the plant. The robot starts at rest; start is x m, y m, heading rad.
  Plant(const RobotModel& model, const Eigen::Vector3d& start);

  /// The voltages act for dt_s, a multiple of the step.
  void advance(const WheelVector& voltages_v, double dt_s, const Disturbance& disturbance = {});
  /// Somebody carries the robot away.
  void displace(const Eigen::Vector3d& by) { pose_ += by; }

  /// x m, y m, unwrapped heading rad.
  const Eigen::Vector3d& pose() const { return pose_; }
  fusion::PlanarPose pose_world_robot() const {
    return {pose_.x(), pose_.y(), fusion::wrap_angle(pose_.z())};
  }
  const Eigen::Vector3d& body_rates() const { return body_rates_; }
  /// Mean of B^T q over the last advance.
  const WheelVector& mean_rim_speeds_mps() const { return mean_rim_speeds_mps_; }

 private:
  const RobotModel* model_;
  Eigen::Vector3d pose_;
  Eigen::Vector3d body_rates_ = Eigen::Vector3d::Zero();
  WheelVector mean_rim_speeds_mps_;
};

}  // namespace nadir::control_client
