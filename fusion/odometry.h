#pragma once

#include <Eigen/Core>

#include "fusion/body_rates.h"
#include "fusion/planar_pose.h"

namespace nadir::fusion {

/// What constant body rates over a time do to a pose, and the derivatives of that.
struct Motion {
  Eigen::Vector2d displacement_world_m = Eigen::Vector2d::Zero();
  double turn_rad = 0.0;
  /// Derivative of the new pose by the rates (u, v, r), s.
  Eigen::Matrix3d by_rates = Eigen::Matrix3d::Zero();

  /// Derivative of the new pose by the old one: the identity, and a third column because a turned
  /// start turns the displacement (theory 3, A13 and A23).
  Eigen::Matrix3d by_pose() const;
};

/// Motion of a robot that starts with this heading and keeps its body rates for dt. With h the
/// heading in the middle of the time and x = r dt / 2 it is exact:
///
///     displacement = dt sin(x)/x Rot(h) (u, v),   turn = r dt
///
/// so one long step and several short ones end at the same place. Euler's step with the first
/// heading loses u r dt^2 / 2 sideways.
Motion constant_rate_motion(double heading_rad, const BodyRates& rates, double dt_s);

/// The pose after a motion from it; the heading wrapped.
PlanarPose moved(const PlanarPose& pose, const Motion& motion);

/// The pose after constant body rates for dt.
inline PlanarPose moved(const PlanarPose& pose, const BodyRates& rates, double dt_s) {
  return moved(pose, constant_rate_motion(pose.heading_rad, rates, dt_s));
}

}  // namespace nadir::fusion
