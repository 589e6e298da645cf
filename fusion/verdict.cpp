#include "fusion/verdict.h"

namespace nadir::fusion {

const char* description(PoseVerdict verdict) {
  switch (verdict) {
    case PoseVerdict::kStarted:
      return "first pose";
    case PoseVerdict::kAccepted:
      return "accepted";
    case PoseVerdict::kRecovered:
      return "accepted after consistent rejections";
    case PoseVerdict::kReset:
      return "reset to a place far away";
    case PoseVerdict::kGated:
      return "beyond the gate";
    case PoseVerdict::kWaitsForOdometry:
      return "waits for odometry";
    case PoseVerdict::kDuplicate:
      return "duplicate";
    case PoseVerdict::kTooOld:
      return "too old";
    case PoseVerdict::kFromTheFuture:
      return "from the future";
    case PoseVerdict::kBeforeOdometry:
      return "before any odometry";
    case PoseVerdict::kNoRoom:
      return "too many poses at once";
    case PoseVerdict::kZeroStamp:
      return "no capture time";
    case PoseVerdict::kNotFinite:
      return "not finite";
    case PoseVerdict::kCovarianceNotSymmetric:
      return "covariance not symmetric";
    case PoseVerdict::kCovarianceNotPositive:
      return "covariance not positive definite";
  }
  return "unknown";
}

const char* description(OdometryVerdict verdict) {
  switch (verdict) {
    case OdometryVerdict::kUsed:
      return "used";
    case OdometryVerdict::kUsedAfterGap:
      return "used after a gap";
    case OdometryVerdict::kClockRestarted:
      return "clock was set";
    case OdometryVerdict::kBehind:
      return "behind what is known";
    case OdometryVerdict::kAhead:
      return "far ahead of what is known";
    case OdometryVerdict::kEmpty:
      return "no time in it";
    case OdometryVerdict::kTooLong:
      return "too long";
    case OdometryVerdict::kZeroStamp:
      return "no time stamp";
    case OdometryVerdict::kNotFinite:
      return "not finite";
  }
  return "unknown";
}

}  // namespace nadir::fusion
