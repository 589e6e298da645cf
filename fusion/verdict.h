#pragma once

#include <cstddef>
#include <cstdint>

namespace nadir::fusion {

/// What became of a pose from outside.
enum class PoseVerdict : std::uint8_t {
  kStarted,           ///< the first: the filter starts here
  kAccepted,          ///< within the gate
  kRecovered,         ///< beyond the gate like others before it: believed, covariance inflated
  kReset,             ///< far away like others before it: the robot was carried there
  kGated,             ///< beyond the gate
  kWaitsForOdometry,  ///< captured a little later than the newest odometry: used when that comes
  kDuplicate,         ///< this camera's frame is known already
  kTooOld,            ///< captured before what the history still holds
  kFromTheFuture,     ///< captured later than odometry by more than the tolerance
  kBeforeOdometry,    ///< no odometry has come yet, so there is no time to compare with
  kNoRoom,            ///< more poses within a moment than the history holds
  kZeroStamp,         ///< capture time zero or before
  kNotFinite,         ///< a number is not finite or absurd
  kCovarianceNotSymmetric,  ///< so it is no covariance
  kCovarianceNotPositive,   ///< a variance of zero or less in some direction
};
inline constexpr std::size_t kPoseVerdicts = 15;

/// Whether a pose with this verdict has changed the estimate.
constexpr bool is_used(PoseVerdict verdict) { return verdict <= PoseVerdict::kReset; }

/// What became of an odometry sample.
enum class OdometryVerdict : std::uint8_t {
  kUsed,
  kUsedAfterGap,    ///< time without odometry lies before it; the covariance grew accordingly
  kClockRestarted,  ///< the clock was set: history forgotten, the estimate kept
  kBehind,          ///< ends before what is known already
  kAhead,           ///< begins so much later that its stamp is doubted
  kEmpty,           ///< ends where it begins, or before
  kTooLong,         ///< one mean rate for a longer time than is sensible
  kZeroStamp,       ///< a stamp zero or before
  kNotFinite,       ///< a rate is not finite or absurd
};
inline constexpr std::size_t kOdometryVerdicts = 9;

constexpr bool is_used(OdometryVerdict verdict) {
  return verdict <= OdometryVerdict::kClockRestarted;
}

/// In plain words, for reports and logs; never null.
const char* description(PoseVerdict verdict);
const char* description(OdometryVerdict verdict);

}  // namespace nadir::fusion
