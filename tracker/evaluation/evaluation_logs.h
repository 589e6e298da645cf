#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fusion/planar_pose.h"

namespace nadir::tracker {

/// One robot in one frame, as the truth or as the tracker has it.
struct LoggedRobot {
  int id = 0;
  std::string team;
  fusion::PlanarPose pose_world_robot;
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();                 ///< (u_px, v_px)
  fusion::PoseCovariance covariance = fusion::PoseCovariance::Zero();  ///< zero in truth files
};

/// One frame of a truth file or of a pose log.
struct LoggedFrame {
  std::uint64_t frame = 0;
  std::int64_t capture_ns = 0;
  double detect_us = 0.0;  ///< stage times; 0 in truth files
  double total_us = 0.0;
  std::vector<LoggedRobot> robots;
};

/// One pose that another process received, as `nadir-listen --json` prints it.
struct ReceivedPose {
  std::uint64_t frame = 0;
  int id = 0;
  std::string team;
  std::int64_t publish_ns = 0;  ///< when the tracker handed it to DDS, since the Unix epoch
  std::int64_t receive_ns = 0;  ///< when the listener had it, on the same machine's clock
};

/// Reads the truth of a recording (nadir-render's truth.jsonl). Throws InputError with file:line.
std::vector<LoggedFrame> read_truth(const std::filesystem::path& file);
/// Reads a tracker's pose log (nadir-tracker --poses). Throws InputError with file:line.
std::vector<LoggedFrame> read_poses(const std::filesystem::path& file);
/// Reads the output of `nadir-listen --json`. Throws InputError with file:line.
std::vector<ReceivedPose> read_received(const std::filesystem::path& file);

}  // namespace nadir::tracker
