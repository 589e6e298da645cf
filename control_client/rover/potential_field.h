#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

namespace nadir::control_client {

/// Velocities down the slope of S4's potentials: towards a way point, away from obstacles.
struct PotentialField {
  double speed_mps = 0.5;           ///< C_S: far from the way point
  double slowing_length_m = 0.5;    ///< sqrt L_S: nearer than about this it becomes slower
  double repulsion_m2ps = 0.05;     ///< C_r
  double repulsion_length_m = 0.4;  ///< L_r

  /// v = -C_S x / sqrt(|x|^2 + L_S), x = position - way point, m/s.
  Eigen::Vector2d attraction_mps(const Eigen::Vector2d& position_m,
                                 const Eigen::Vector2d& way_point_m) const;
  /// v = (C_r / L_r) exp(-|x| / L_r) x / |x|, x = position - obstacle; zero on the obstacle itself.
  Eigen::Vector2d repulsion_mps(const Eigen::Vector2d& position_m,
                                const Eigen::Vector2d& obstacle_m) const;
};

/// Way points one after the other; the last is kept.
class WaypointTour {
 public:
  /// At least one way point; one is reached within `reach_m` of it.
  WaypointTour(std::vector<Eigen::Vector2d> way_points_m, double reach_m)
      : way_points_m_(std::move(way_points_m)), reach_m_(reach_m) {}

  /// The way point to go to from here, after those are taken off that are reached.
  const Eigen::Vector2d& next(const Eigen::Vector2d& position_m);
  bool is_done() const { return is_done_; }

 private:
  std::vector<Eigen::Vector2d> way_points_m_;
  double reach_m_;
  std::size_t at_ = 0;
  bool is_done_ = false;
};

}  // namespace nadir::control_client
