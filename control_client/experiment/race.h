#pragma once

#include <Eigen/Core>
#include <vector>

#include "control_client/nominal_motion.h"
#include "fusion/planar_pose.h"

namespace nadir::control_client {

/// The race of S3 2.2: straight to one corner after the other at a set speed, heading 0.
struct RaceParameters {
  std::vector<Eigen::Vector2d> corners_m = {{0.2, -0.2}, {0.2, 0.2}, {-0.2, 0.2}, {-0.2, -0.2}};
  double speed_mps = 0.3;
  double heading_gain_per_s = 3.0;
  double arrival_m = 0.02;  ///< in x and in y
};

/// Who leads the robot through a race, by what it believes of its pose.
class RaceGuidance {
 public:
  explicit RaceGuidance(const RaceParameters& parameters) : parameters_(parameters) {}

  /// Body rates for the next tick; changes to the next corner where this one is reached.
  Eigen::Vector3d body_rates(const fusion::PlanarPose& pose);
  const Eigen::Vector2d& corner_m() const { return parameters_.corners_m[corner_]; }

 private:
  RaceParameters parameters_;
  std::size_t corner_ = 0;
};

}  // namespace nadir::control_client
