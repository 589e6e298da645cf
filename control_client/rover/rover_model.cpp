#include "control_client/rover/rover_model.h"

#include <cmath>
#include <numbers>

namespace nadir::control_client {

Eigen::Matrix3d RoverModel::wheel_matrix(double heading_rad) const {
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  const double root = std::numbers::sqrt3;
  const double arm = parameters_.arm_m;
  Eigen::Matrix3d b;
  b << -c, 0.5 * (c + root * s), 0.5 * (c - root * s),  //
      -s, 0.5 * (s - root * c), 0.5 * (s + root * c),   //
      arm, arm, arm;
  return b;
}

Eigen::Vector3d RoverModel::wheel_forces(double heading_rad, const Eigen::Vector3d& force) const {
  const double arm = parameters_.arm_m;
  const Eigen::Vector3d squares(1.5, 1.5, 3.0 * arm * arm);
  return wheel_matrix(heading_rad).transpose() * force.cwiseQuotient(squares);
}

}  // namespace nadir::control_client
