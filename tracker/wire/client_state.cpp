#include "tracker/wire/client_state.h"

namespace nadir::tracker {

const char* name_of(ClientMode mode) {
  switch (mode) {
    case ClientMode::kStarting:
      return "starting";
    case ClientMode::kDriving:
      return "driving";
    case ClientMode::kSlow:
      return "slow";
    case ClientMode::kStopped:
      return "stopped";
    case ClientMode::kEmergency:
      return "emergency";
    case ClientMode::kFinished:
      return "finished";
  }
  return "?";
}

const char* name_of(ClientReason reason) {
  switch (reason) {
    case ClientReason::kNone:
      return "none";
    case ClientReason::kNoPose:
      return "no pose";
    case ClientReason::kPoseTooOld:
      return "pose too old";
    case ClientReason::kUncertain:
      return "uncertain";
    case ClientReason::kNoClock:
      return "clock unknown";
    case ClientReason::kClockJump:
      return "clock jump";
    case ClientReason::kNoOdometry:
      return "no odometry";
    case ClientReason::kEmergencyStop:
      return "emergency stop";
    case ClientReason::kSaturated:
      return "saturated";
    case ClientReason::kOffTrack:
      return "off track";
    case ClientReason::kTrajectoryOver:
      return "trajectory over";
    case ClientReason::kInterrupted:
      return "interrupted";
    case ClientReason::kOther:
      return "other";
  }
  return "?";
}

}  // namespace nadir::tracker
