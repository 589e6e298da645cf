#include "control_client/differential/inertial_sensors.h"

#include <cmath>

namespace nadir::control_client {

double SimulatedGyro::sample(double turn_rate_radps, double dt_s) {
  bias_radps_ += errors_.bias_walk_radps * std::sqrt(dt_s) * random_.normal();
  return turn_rate_radps + bias_radps_ + errors_.gyro_radps * random_.normal();
}

Eigen::Vector3d SimulatedMagnetometer::sample(double heading_rad, const MagneticField& field) {
  const Eigen::Vector2d world = Eigen::Vector2d(1.0, 0.0) + field.disturbance_world;
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  // The robot's y axis of this frame points to the right.
  return {c * world.x() + s * world.y() + errors_.field_share * random_.normal(),
          s * world.x() - c * world.y() + errors_.field_share * random_.normal(), field.down};
}

}  // namespace nadir::control_client
