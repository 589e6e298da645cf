#pragma once

namespace nadir::tracker {

/// One topic for each kind of stream; the type's generation stands in the name, so that a tracker
/// and a robot of different generations do not meet.
inline constexpr const char* kRobotPoseTopic =
    "nadir/robot_pose/1";  ///< keyed samples: the robots read these
inline constexpr const char* kFrameTopic = "nadir/frame/1";  ///< whole frames: for monitors only

}  // namespace nadir::tracker
