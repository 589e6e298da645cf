#include "control_client/experiment/race.h"

namespace nadir::control_client {

Eigen::Vector3d RaceGuidance::body_rates(const fusion::PlanarPose& pose) {
  if ((corner_m() - pose.position_m()).cwiseAbs().maxCoeff() < parameters_.arrival_m) {
    corner_ = (corner_ + 1) % parameters_.corners_m.size();
  }
  const Eigen::Vector2d way = corner_m() - pose.position_m();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  velocity.head<2>() = parameters_.speed_mps * way.normalized();
  velocity.z() = -parameters_.heading_gain_per_s * pose.heading_rad;
  return rotation_world_body(pose.heading_rad).transpose() * velocity;
}

}  // namespace nadir::control_client
