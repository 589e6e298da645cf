#include "control_client/outer_loop.h"

namespace nadir::control_client {

Eigen::Matrix3d OuterLoop::proportional_gain(const NominalMotion& nominal) const {
  Eigen::Vector3d rates = nominal.body_rates();
  Eigen::Matrix3d gain =
      rotation_world_body(nominal.pose.z()).transpose() * parameters_.proportional_gain_per_s();
  gain(0, 2) -= rates.y();
  gain(1, 2) += rates.x();
  return gain;
}

Eigen::Matrix3d OuterLoop::integral_gain(const NominalMotion& nominal) const {
  return rotation_world_body(nominal.pose.z()).transpose() * parameters_.integral_gain_per_s2();
}

Eigen::Vector3d OuterLoop::body_rate_command(const NominalMotion& nominal,
                                             const fusion::PlanarPose& pose, double dt_s,
                                             bool integrate) {
  const Eigen::Vector3d error = {pose.x_m - nominal.pose.x(), pose.y_m - nominal.pose.y(),
                                 fusion::wrap_angle(pose.heading_rad - nominal.pose.z())};
  if (integrate) error_integral_ += dt_s * error;
  return nominal.body_rates() - proportional_gain(nominal) * error -
         integral_gain(nominal) * error_integral_;
}

}  // namespace nadir::control_client
