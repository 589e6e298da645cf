#include "control_client/differential/unicycle_steering.h"

#include <algorithm>
#include <cmath>

namespace nadir::control_client {

Eigen::Vector3d UnicycleSteering::body_rates(const fusion::PlanarPose& estimate,
                                             const NominalMotion& motion, double dt_s) {
  constexpr double kSlow_mps = 0.05;
  const Eigen::Vector3d rates = motion.body_rates();
  const UnicycleReference reference{
      {motion.pose.x(), motion.pose.y(), fusion::wrap_angle(motion.pose.z())},
      {rates.x(), rates.z()}};
  DecentralisedSettings settings;
  settings.gains = closed_form_gains(weights_, std::max(std::abs(rates.x()), 1e-6));
  // A robot that stands cannot move to the side: turning would only cost heading.
  settings.gains(1, 1) *= std::clamp(rates.x() / kSlow_mps, -1.0, 1.0);
  const UnicycleMotion command =
      TrackingController(settings, limits_).command(reference, estimate, dt_s);
  return {command.speed_mps, 0.0, command.turn_rate_radps};
}

}  // namespace nadir::control_client
