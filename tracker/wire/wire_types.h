#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fusion/planar_pose.h"

namespace nadir::tracker {

// Bounds of the wire's types; nadir.idl states the same numbers.
inline constexpr std::size_t kMaxTeamLength = 15;      ///< bytes
inline constexpr std::size_t kMaxCameraLength = 31;    ///< bytes
inline constexpr std::size_t kMaxWireMarkers = 8;      ///< markers of a robot
inline constexpr std::size_t kMaxRobotsInFrame = 128;  ///< robots in one frame summary

/// What one frame says of one robot.
struct WireRobot {
  std::string team;  ///< at most kMaxTeamLength bytes
  std::int32_t robot = 0;
  fusion::PlanarPose pose_world_robot;
  fusion::PoseCovariance covariance = fusion::PoseCovariance::Zero();
  double u_px = 0.0;  ///< image of the robot's origin
  double v_px = 0.0;
  double confidence = 0.0;                              ///< 0 to 1
  std::array<std::uint32_t, kMaxWireMarkers> pixels{};  ///< pixels seen of each marker
  std::size_t marker_count = 0;                         ///< entries of `pixels` that count
};

/// One sample of the robots' stream. Team, robot and camera are its key.
struct WirePose {
  WireRobot robot;
  std::string camera;  ///< at most kMaxCameraLength bytes
  std::uint64_t epoch =
      0;  ///< one run of a tracker, its start in ns: frame numbers start anew with it
  std::uint64_t frame = 0;
  std::int64_t capture_ns = 0;  ///< middle of the exposure, since the Unix epoch
  std::int64_t publish_ns = 0;  ///< set by PoseWriter
};

/// Time spent on one frame, microseconds on the tracker's steady clock.
struct WireStageTimes {
  double read_us = 0.0;
  double detect_us = 0.0;
  double map_us = 0.0;
  double total_us = 0.0;
};

/// One sample of the monitors' stream: a whole frame, also where no robot is seen. The camera is
/// its key.
struct WireFrame {
  std::string camera;  ///< at most kMaxCameraLength bytes
  std::uint64_t epoch = 0;
  std::uint64_t frame = 0;
  std::int64_t capture_ns = 0;
  std::int64_t publish_ns = 0;  ///< set by PoseWriter
  WireStageTimes stages;
  std::uint32_t rejected = 0;     ///< candidates that were no robot
  std::vector<WireRobot> robots;  ///< at most kMaxRobotsInFrame
};

}  // namespace nadir::tracker
