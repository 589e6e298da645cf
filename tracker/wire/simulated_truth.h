#pragma once

#include <cstdint>
#include <string>

#include "fusion/planar_pose.h"

namespace nadir::tracker {

/// Where a simulated robot really is and how it moves: for the synthetic camera, and for those who
/// judge an estimate. Team and robot are the key.
struct WireSimulatedTruth {
  std::string team;  ///< at most kMaxTeamLength bytes
  std::int32_t robot = 0;
  std::uint64_t epoch = 0;   ///< one run of a simulation
  std::int64_t time_ns = 0;  ///< when it is there: wall clock of the machine, since the Unix epoch,
                             ///< never the clock of a client that is wrong on purpose
  fusion::PlanarPose pose_world_robot;
  double velocity_x_mps = 0.0;  ///< world frame
  double velocity_y_mps = 0.0;
  double heading_rate_radps = 0.0;
};

}  // namespace nadir::tracker
