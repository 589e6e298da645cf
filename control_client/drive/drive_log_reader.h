#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "fusion/planar_pose.h"

namespace nadir::control_client {

/// One tick of a log with truth.
struct DriveRow {
  double time_s = 0.0;
  bool drives = false;   ///< the robot was meant to move
  bool slowed = false;   ///< or stopped: something was not as it should be
  bool follows = false;  ///< on the trajectory itself, not on the way to it
  fusion::PlanarPose command;
  fusion::PlanarPose nominal;
  fusion::PlanarPose estimate;
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();  ///< of the estimate: m, m, rad
  fusion::PlanarPose encoders;                      ///< where they alone lead
  fusion::PlanarPose truth;
  double ticks_missed = 0.0;  ///< until now
};

struct DriveRecord {
  std::string name;  ///< of the file
  std::vector<DriveRow> rows;
};

/// Reads what DriveLog wrote of a simulated robot. Throws vision::InputError: not a log, no truth
/// in it, no rows.
DriveRecord read_drive_log(const std::filesystem::path& file);

}  // namespace nadir::control_client
