#pragma once

// The functions of DelayedFusion: odometry and poses in, its health, and the other file; included
// by its header alone.

#include <algorithm>
#include <cassert>
#include <limits>

#include "fusion/delayed_fusion.h"

namespace nadir::fusion {

template <class L, OdometryErrorModel E>
void DelayedFusion<L, E>::start(Timestamp time, const PlanarPose& pose,
                                const PoseCovariance& covariance) {
  filter_.start(pose, covariance);
  track_ = Track{};
  restart(time);
}

template <class L, OdometryErrorModel E>
void DelayedFusion<L, E>::restart(Timestamp from) {
  has_time_ = true;
  intervals_.restart(from);
  frames_.clear();
}

template <class L, OdometryErrorModel E>
OdometryVerdict DelayedFusion<L, E>::add_odometry(const Odometry& odometry) {
  const auto counted = [this](OdometryVerdict verdict) {
    ++odometry_counts_.at(static_cast<std::size_t>(verdict));
    return verdict;
  };
  if (const auto reason =
          reason_to_refuse(odometry.from, odometry.to, odometry.mean_rates, settings_.odometry)) {
    return counted(*reason);
  }
  if (!has_time_) restart(odometry.from);
  const OdometryVerdict verdict =
      clock_.compare(now(), odometry.from, odometry.to, settings_.odometry);
  if (!is_used(verdict)) return counted(verdict);

  if (verdict == OdometryVerdict::kClockRestarted) {
    // How long the robot drove by the new clock without being heard.
    filter_.predict_gap(track_.last_rates.value_or(BodyRates{}),
                        to_seconds(odometry.to - clock_.run_began()));
    track_ = Track{};
    restart(odometry.from);
  } else if (verdict == OdometryVerdict::kUsedAfterGap) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    push({odometry.from, {kUnknown, kUnknown, kUnknown}, Nominal{}});
  }
  push({odometry.to, odometry.mean_rates, odometry.nominal});
  return counted(verdict);
}

template <class L, OdometryErrorModel E>
void DelayedFusion<L, E>::push(const typename Intervals::Interval& interval) {
  if (intervals_.is_full()) forget_block();
  intervals_.push(interval);
  const std::uint64_t index = intervals_.end() - 1;
  std::size_t next_frame = frames_.first_after(intervals_.from(index));
  run_live(index, next_frame, [](const FrameRecord&, const Correction&) {});
}

template <class L, OdometryErrorModel E>
void DelayedFusion<L, E>::forget_block() {
  intervals_.forget_block();
  frames_.forget_until(intervals_.oldest());
}

template <class L, OdometryErrorModel E>
Correction DelayedFusion<L, E>::add_pose(const VisionPose& pose) {
  Correction result;
  add_poses({&pose, 1}, {&result, 1});
  return result;
}

template <class L, OdometryErrorModel E>
void DelayedFusion<L, E>::add_poses(std::span<const VisionPose> poses,
                                    std::span<Correction> results) {
  assert(poses.size() == results.size());
  const auto report = [&](const FrameRecord& record, const Correction& correction) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (results[i].verdict == PoseVerdict::kWaitsForOdometry && record.is_frame_of(poses[i])) {
        results[i] = correction;
      }
    }
  };
  std::fill(results.begin(), results.end(), Correction{});
  Timestamp earliest = Timestamp::max();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (frames_.is_full() &&
        earliest <= now()) {  // what is inserted is used before it is forgotten
      replay(earliest, report);
      earliest = Timestamp::max();
    }
    const PoseVerdict verdict = insert(poses[i]);
    ++pose_counts_.at(static_cast<std::size_t>(verdict));
    results[i].verdict = verdict;
    if (verdict == PoseVerdict::kWaitsForOdometry) earliest = std::min(earliest, poses[i].capture);
  }
  if (earliest <= now()) replay(earliest, report);
}

template <class L, OdometryErrorModel E>
PoseVerdict DelayedFusion<L, E>::insert(const VisionPose& pose) {
  if (const auto reason = refusal(pose)) return *reason;
  while (frames_.is_full() && intervals_.has_more_than_a_block()) forget_block();
  if (frames_.is_full()) return PoseVerdict::kNoRoom;
  if (pose.capture <= horizon()) return PoseVerdict::kTooOld;
  frames_.insert(FrameRecord(pose));
  return PoseVerdict::kWaitsForOdometry;
}

template <class L, OdometryErrorModel E>
std::optional<PoseVerdict> DelayedFusion<L, E>::refusal(const VisionPose& pose) const {
  if (pose.capture.count() <= 0) return PoseVerdict::kZeroStamp;
  if (const auto reason = reason_to_refuse(pose.pose, pose.covariance)) return reason;
  if (!has_time_) return PoseVerdict::kBeforeOdometry;
  if (frames_.knows(pose)) return PoseVerdict::kDuplicate;
  if (pose.capture <= horizon()) return PoseVerdict::kTooOld;
  if (pose.capture - now() > settings_.future_tolerance) return PoseVerdict::kFromTheFuture;
  return std::nullopt;
}

template <class L, OdometryErrorModel E>
FusionHealth DelayedFusion<L, E>::health() const {
  FusionHealth health;
  health.now = now();
  if (track_.last_used) health.age_of_last_used = now() - *track_.last_used;
  health.poses = pose_counts_;
  health.odometry = odometry_counts_;
  health.revised = revised_;
  double sum = 0.0;
  for (const FrameRecord& record : frames()) {
    if (record.verdict != PoseVerdict::kAccepted) continue;
    sum += static_cast<double>(record.nis);
    ++health.nis_poses;
  }
  if (health.nis_poses > 0) health.nis_mean = sum / health.nis_poses;
  return health;
}

template <class L, OdometryErrorModel E>
std::size_t DelayedFusion<L, E>::memory_bytes() const {
  return sizeof(*this) +
         settings_.history.blocks * settings_.history.block_length *
             sizeof(typename Intervals::Interval) +
         settings_.history.poses * sizeof(FrameRecord) + snapshots_.size() * sizeof(Snapshot);
}

}  // namespace nadir::fusion

#include "fusion/delayed_fusion_replay_impl.h"
