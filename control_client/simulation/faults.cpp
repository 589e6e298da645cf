#include "control_client/simulation/faults.h"

namespace nadir::control_client {

Disturbance CableDrag::at(const Eigen::Vector2d& position_m) const {
  const Eigen::Vector2d to_anchor = anchor_m - position_m;
  const double length_m = to_anchor.norm();
  if (length_m <= free_length_m) return {};
  const Eigen::Vector2d pull_m = (length_m - free_length_m) / length_m * to_anchor;
  return {acceleration_per_s2 * pull_m, creep_per_s * pull_m};
}

}  // namespace nadir::control_client
