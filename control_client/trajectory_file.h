#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "control_client/trajectory.h"

namespace nadir::control_client {

/// Bounds of a motion along waypoints.
struct MotionLimits {
  double speed_mps = 0.3;
  double acceleration_mps2 = 0.6;
  double turn_rate_radps = 1.5;
  double turn_acceleration_radps2 = 4.0;
};

/// Straight lines from waypoint to waypoint (x m, y m, heading rad; two at least), at rest in each.
/// Each leg follows the quintic 10 s^3 - 15 s^4 + 6 s^5 and takes just as long as the limits ask
/// for. Equal waypoints in a row are passed at once.
TrajectoryPtr waypoint_trajectory(const std::vector<Eigen::Vector3d>& waypoints,
                                  const MotionLimits& limits);

/// Cubic spline through poses (x m, y m, unwrapped heading rad) at rising times from 0, at rest at
/// both ends; two poses at least. Velocity and acceleration are continuous.
TrajectoryPtr spline_trajectory(const std::vector<double>& times_s,
                                const std::vector<Eigen::Vector3d>& poses);

/// Reads a trajectory.
/// FILE.csv: t_s,x_m,y_m,heading_rad with rising times; a spline. The first time counts as 0, a
/// heading may wrap from row to row.
/// FILE.yaml: waypoints: [[x_m, y_m, heading_rad], ...] as a list of maps, and optional limits:
///
///     waypoints:
///       - {x_m: 0.0, y_m: 0.0, heading_rad: 0.0}
///       - {x_m: 1.0, y_m: 0.0}
///     speed_mps: 0.3
///     acceleration_mps2: 0.6
///
/// Throws InputError.
TrajectoryPtr load_trajectory(const std::filesystem::path& file);

/// A standard trajectory by its name, or one from a file, `speed` times as fast (above 0). Throws
/// InputError if there is none, or if it asks for more speed or voltage than the robot has.
TrajectoryPtr choose_trajectory(const std::string& name_or_file, const RobotModel& model,
                                double speed = 1.0);

/// The same, but slower where the robot could not follow otherwise.
TrajectoryPtr fitting_trajectory(const std::string& name_or_file, const RobotModel& model,
                                 double speed = 1.0);

}  // namespace nadir::control_client
