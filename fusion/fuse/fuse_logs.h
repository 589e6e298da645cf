#pragma once

#include <filesystem>
#include <vector>

#include "fusion/body_rates.h"
#include "fusion/planar_pose.h"

namespace nadir::fusion {

/// Body rates of the odometry, measured at t_s and valid up to the next row.
struct OdometryRow {
  double t_s = 0.0;
  BodyRates rates;
  int line = 0;  ///< of the file, from 1
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
  int line = 0;

  PoseCovariance covariance() const {
    return Eigen::Vector3d(var_x_m2, var_y_m2, var_heading_rad2).asDiagonal();
  }
};

/// Where the robot was.
struct TruthRow {
  double t_s = 0.0;
  PlanarPose pose;
};

/// What the robot was meant to do: heading at t_s, and the body rates up to the next row.
struct NominalRow {
  double t_s = 0.0;
  double heading_rad = 0.0;
  BodyRates rates;
};

/// Logs of nadir-fuse, comma separated. A row is what a robot might have heard: numbers that make
/// no sense (nan, inf, a negative variance, a time that jumps back) are left to the filter, which
/// refuses and counts them. Text that is no number, a missing column, a file without rows, poses
/// that are not in order of arrival and a truth or nominal that is not in order of time throw
/// vision::InputError with file:line:column.
std::vector<OdometryRow> load_odometry(const std::filesystem::path& file);
/// May be empty: a robot that sees nothing.
std::vector<VisionRow> load_vision(const std::filesystem::path& file);
std::vector<TruthRow> load_truth(const std::filesystem::path& file);
std::vector<NominalRow> load_nominal(const std::filesystem::path& file);

}  // namespace nadir::fusion
