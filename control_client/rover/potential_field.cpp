#include "control_client/rover/potential_field.h"

#include <cmath>

namespace nadir::control_client {

Eigen::Vector2d PotentialField::attraction_mps(const Eigen::Vector2d& position_m,
                                               const Eigen::Vector2d& way_point_m) const {
  const Eigen::Vector2d x = position_m - way_point_m;
  return -speed_mps / std::sqrt(x.squaredNorm() + slowing_length_m * slowing_length_m) * x;
}

Eigen::Vector2d PotentialField::repulsion_mps(const Eigen::Vector2d& position_m,
                                              const Eigen::Vector2d& obstacle_m) const {
  const Eigen::Vector2d x = position_m - obstacle_m;
  const double distance_m = x.norm();
  if (distance_m == 0.0) return Eigen::Vector2d::Zero();
  return repulsion_m2ps / repulsion_length_m * std::exp(-distance_m / repulsion_length_m) /
         distance_m * x;
}

const Eigen::Vector2d& WaypointTour::next(const Eigen::Vector2d& position_m) {
  while (!is_done_ && (position_m - way_points_m_[at_]).norm() < reach_m_) {
    if (at_ + 1 == way_points_m_.size()) {
      is_done_ = true;
    } else {
      ++at_;
    }
  }
  return way_points_m_[at_];
}

}  // namespace nadir::control_client
