#pragma once

#include <Eigen/Core>

#include "control_client/trajectory.h"
#include "fusion/planar_pose.h"

namespace nadir::control_client {

/// How a robot with two driven wheels moves: along its heading, and about its centre.
struct UnicycleMotion {
  double speed_mps = 0.0;  ///< forward
  double turn_rate_radps = 0.0;
};

/// Rim speeds of both wheels, m/s.
struct WheelSpeeds {
  double left_mps = 0.0;
  double right_mps = 0.0;
};

/// v = (v_R + v_L) / 2, w = (v_R - v_L) / L; L: distance of the wheels (theory 7).
WheelSpeeds wheel_speeds(const UnicycleMotion& motion, double track_m);
UnicycleMotion motion_of(const WheelSpeeds& wheels, double track_m);

/// The pose after moving at constant rates for dt_s: an arc, exactly.
fusion::PlanarPose moved(const fusion::PlanarPose& pose, const UnicycleMotion& motion, double dt_s);

/// Where a unicycle should be and how it moves there.
struct UnicycleReference {
  fusion::PlanarPose pose;
  UnicycleMotion motion;  ///< v_r, w_r
};

/// What a path asks of a robot that cannot move sideways: its heading is the direction of motion,
/// or the opposite one where it drives backwards (S1 eq 4 to 6). A standing reference keeps
/// `heading_at_rest_rad`, and does not turn.
///
///     v_r = +-|p'|,  w_r = (x' y'' - y' x'') / |p'|^2
UnicycleReference reference_along(const TrajectoryPoint& point, bool backwards,
                                  double heading_at_rest_rad);

/// (e1, e2, e3) = (ahead m, to the left m, heading rad in (-pi, pi]) of the reference as the robot
/// sees it: Rot(theta)^T (p_r - p), S1 eq 8.
Eigen::Vector3d tracking_error(const UnicycleReference& reference, const fusion::PlanarPose& pose);

}  // namespace nadir::control_client
