#pragma once

#include <cstdint>

#include "fusion/planar_pose.h"
#include "fusion/timestamp.h"

namespace nadir::fusion {

/// One frame's pose of this robot, as a camera's tracker reported it.
struct VisionPose {
  std::uint32_t camera = 0;
  std::uint32_t epoch = 0;  ///< of the tracker: another one counts its frames anew
  std::uint64_t frame = 0;
  Timestamp capture{0};  ///< middle of the exposure, on the odometry's clock
  PlanarPose pose;       ///< of the robot in the world
  PoseCovariance covariance = PoseCovariance::Zero();
};

/// Whether both are the same frame of the same camera.
inline bool same_frame(const VisionPose& a, const VisionPose& b) {
  return a.camera == b.camera && a.epoch == b.epoch && a.frame == b.frame;
}

}  // namespace nadir::fusion
