#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "fusion/planar_pose.h"

namespace nadir::tracker {

inline constexpr std::size_t kMaxWireText = 79;  ///< bytes of a text for people

/// What a client does with its robot.
enum class ClientMode : std::uint8_t {
  kStarting,   ///< waits for what it needs before it may drive
  kDriving,    ///< follows its trajectory
  kSlow,       ///< follows it slowed down: something is doubtful
  kStopped,    ///< stands until the reason is gone
  kEmergency,  ///< stands because of an emergency stop
  kFinished,   ///< the trajectory is over
};

/// Why it is not simply driving.
enum class ClientReason : std::uint8_t {
  kNone,
  kNoPose,         ///< no pose has come yet
  kPoseTooOld,     ///< the newest pose's capture is too long ago
  kUncertain,      ///< the estimate's covariance is too large
  kNoClock,        ///< the offset to the tracker's clock is not known yet
  kClockJump,      ///< a clock was set
  kNoOdometry,     ///< the robot base is silent
  kEmergencyStop,  ///< somebody engaged an emergency stop
  kSaturated,      ///< the trajectory asks more than the motors give
  kOffTrack,       ///< the robot is too far from its trajectory
  kTrajectoryOver,
  kInterrupted,  ///< the client was asked to end
  kOther,        ///< see the text
};

/// Words for people and for JSON, such as "driving", "pose too old"; "?" for a number that is none
/// of them.
const char* name_of(ClientMode mode);
const char* name_of(ClientReason reason);

/// What happened to poses and ticks since the client's start.
struct WireClientCounts {
  std::uint64_t poses_accepted = 0;
  std::uint64_t poses_rejected = 0;  ///< by the gate
  std::uint64_t poses_late = 0;      ///< too old for the history
  std::uint64_t poses_lost = 0;      ///< gaps in the frame numbers
  std::uint64_t recoveries = 0;
  std::uint64_t odometry_samples = 0;
  std::uint64_t ticks = 0;
  std::uint64_t ticks_missed = 0;
};

/// A client to its monitors. Team and robot are the key.
struct WireClientState {
  std::string team;  ///< at most kMaxTeamLength bytes
  std::int32_t robot = 0;
  std::uint64_t epoch = 0;  ///< one run of a client
  std::uint64_t sequence = 0;
  std::int64_t stamp_ns = 0;  ///< client's clock
  ClientMode mode = ClientMode::kStarting;
  ClientReason reason = ClientReason::kNone;
  std::string text;  ///< at most kMaxWireText bytes
  fusion::PlanarPose estimate_world_robot;
  fusion::PoseCovariance covariance = fusion::PoseCovariance::Zero();
  fusion::PlanarPose nominal_world_robot;  ///< where the trajectory wants the robot now
  double error_ahead_m = 0.0;              ///< estimate minus nominal, in the nominal's frame
  double error_left_m = 0.0;
  double error_heading_rad = 0.0;  ///< (-pi, pi]
  std::int64_t pose_age_ns = -1;   ///< since the newest pose's capture; -1 before the first
  WireClientCounts counts;
  std::int64_t clock_offset_ns = 0;  ///< tracker's clock minus the client's
  std::int64_t clock_sigma_ns = -1;  ///< of that, 1 sigma; -1: not known yet
};

}  // namespace nadir::tracker
