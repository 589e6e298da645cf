#pragma once

namespace nadir::tracker {

/// One topic for each kind of stream; the type's generation stands in the name, so that a tracker
/// and a robot of different generations do not meet.
inline constexpr const char* kRobotPoseTopic =
    "nadir/robot_pose/1";  ///< keyed samples: the robots read these
inline constexpr const char* kFrameTopic = "nadir/frame/1";  ///< whole frames: for monitors only
inline constexpr const char* kWheelCommandTopic =
    "nadir/wheel_command/1";                                       ///< client to robot base
inline constexpr const char* kOdometryTopic = "nadir/odometry/1";  ///< robot base to client
inline constexpr const char* kClientStateTopic =
    "nadir/client_state/1";  ///< client to whoever watches
inline constexpr const char* kEmergencyStopTopic =
    "nadir/emergency_stop/1";  ///< anybody to all clients
inline constexpr const char* kSimulatedTruthTopic =
    "nadir/simulated_truth/1";  ///< simulated robot to synthetic camera
inline constexpr const char* kClockRequestTopic = "nadir/clock_request/1";  ///< client to trackers
inline constexpr const char* kClockReplyTopic = "nadir/clock_reply/1";      ///< tracker to clients

}  // namespace nadir::tracker
