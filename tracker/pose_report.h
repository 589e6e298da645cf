#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fusion/planar_pose.h"
#include "vision/marker_observation.h"

namespace nadir::tracker {

/// One robot in one frame: what the frame says of it, not smoothed.
struct RobotReport {
  int id = 0;             ///< robot number, or the track number of an anonymous robot
  std::string_view team;  ///< the layout's team name; lives as long as the pipeline
  fusion::PlanarPose pose_world_robot;
  fusion::PoseCovariance covariance = fusion::PoseCovariance::Zero();
  vision::PixelPoint centre_px = vision::PixelPoint::Zero();  ///< image of the robot's origin
  std::array<int, vision::kMaxDiscs> pixels{};                ///< pixels seen of each marker
  int marker_count = 0;
  double confidence = 0.0;  ///< 0 to 1
  /// True if the pose was aligned with the pixels, false if it is made of what a detector measured.
  bool aligned = false;
};

struct RejectionReport {
  vision::PixelPoint centre_px = vision::PixelPoint::Zero();
  const char* reason = "";
};

/// Time spent on one frame, microseconds on the steady clock. total = detect + map + all up to the
/// finished pose.
struct StageTimes {
  double read_us = 0.0;
  double detect_us = 0.0;
  double map_us = 0.0;
  double total_us = 0.0;
};

/// Everything that is known after one frame, also where no robot is seen. Vectors keep their
/// memory.
struct FrameReport {
  std::uint64_t frame = 0;
  std::string camera;
  std::int64_t capture_ns = 0;  ///< middle of the exposure, since the Unix epoch
  StageTimes stages;
  std::vector<RobotReport> robots;
  std::vector<RejectionReport> rejected;
  std::int64_t rejected_not_listed = 0;  ///< further ones, of which only the number is known
};

}  // namespace nadir::tracker
