#pragma once

#include <Eigen/Core>

#include "control_client/nominal_motion.h"
#include "fusion/planar_pose.h"

namespace nadir::control_client {

/// Leads a robot along a motion in another way than the outer loop, which wants to move in all
/// directions.
class Steering {
 public:
  virtual ~Steering() = default;

  /// Body rates for the next dt_s > 0 (u, v in m/s, r in rad/s).
  virtual Eigen::Vector3d body_rates(const fusion::PlanarPose& estimate,
                                     const NominalMotion& motion, double dt_s) = 0;

 protected:
  Steering() = default;
  Steering(const Steering&) = default;
  Steering& operator=(const Steering&) = default;
};

}  // namespace nadir::control_client
