#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "fusion/body_rates.h"
#include "fusion/planar_pose.h"
#include "fusion/timestamp.h"
#include "fusion/verdict.h"

namespace nadir::fusion {

/// Where the robot is at a time, and how well that is known.
struct Estimate {
  Timestamp time{0};
  PlanarPose pose;
  PoseCovariance covariance = PoseCovariance::Zero();
  BodyRates rates;  ///< the last measured, as the model of the odometry's errors corrects them
};

/// How the fusion fares. Poses count by what is thought of them now: a late one can change the
/// verdict on those captured after it.
struct FusionHealth {
  Timestamp now{0};  ///< end of the newest odometry
  /// Since the capture of the newest pose that was used; nothing before the first.
  std::optional<std::chrono::nanoseconds> age_of_last_used;
  std::array<std::uint64_t, kPoseVerdicts> poses = {};
  std::array<std::uint64_t, kOdometryVerdicts> odometry = {};
  std::uint64_t revised = 0;  ///< verdicts that a replay changed
  /// Mean normalised innovation squared of the accepted poses in the history, expectation about 3
  /// (2.92 where the gate cuts at 3 sigma), and their number.
  double nis_mean = 0.0;
  int nis_poses = 0;

  std::uint64_t count(PoseVerdict verdict) const {
    return poses.at(static_cast<std::size_t>(verdict));
  }
  std::uint64_t count(OdometryVerdict verdict) const {
    return odometry.at(static_cast<std::size_t>(verdict));
  }
};

}  // namespace nadir::fusion
