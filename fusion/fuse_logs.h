#pragma once

#include <filesystem>
#include <vector>

#include "fusion/planar_pose.h"

namespace nadir::fusion {

/// Body rates of the odometry: u along the robot's x axis, v along its y axis, r its yaw rate.
/// Measured at t_s and valid up to the next row.
struct OdometryRow {
  double t_s = 0.0;
  double u_mps = 0.0;
  double v_mps = 0.0;
  double r_radps = 0.0;
};

/// A pose that vision captured at one time and that arrived at another, variances without
/// correlation.
struct VisionRow {
  double t_capture_s = 0.0;
  double t_arrival_s = 0.0;
  PlanarPose pose;
  double var_x_m2 = 0.0;
  double var_y_m2 = 0.0;
  double var_heading_rad2 = 0.0;
};

/// Where the robot was.
struct TruthRow {
  double t_s = 0.0;
  PlanarPose pose;
};

}  // namespace nadir::fusion
