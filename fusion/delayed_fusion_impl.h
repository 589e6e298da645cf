#pragma once

// The functions of DelayedFusion; included by its header alone.

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
template <class Report>
void DelayedFusion<L, E>::replay(Timestamp capture, Report report) {
  std::uint64_t index = intervals_.containing(capture);
  index -= index % intervals_.block_length();
  filter_.set_state(snapshot(index).state);
  track_ = snapshot(index).track;
  std::size_t next_frame = frames_.first_after(intervals_.from(index));
  for (; index < intervals_.end(); ++index) run_live(index, next_frame, report);
}

template <class L, OdometryErrorModel E>
template <class Report>
void DelayedFusion<L, E>::run_live(std::uint64_t index, std::size_t& next_frame, Report report) {
  if (index % intervals_.block_length() == 0) snapshot(index) = {filter_.state(), track_};
  run(filter_, track_, index, intervals_[index].to, next_frame,
      [&](std::size_t frame, const Correction& correction) {
        decide(frames_[frame], correction);
        report(frames_[frame], correction);
      });
}

template <class L, OdometryErrorModel E>
template <class Report>
void DelayedFusion<L, E>::run(Filter& filter, Track& track, std::uint64_t index, Timestamp until,
                              std::size_t& next_frame, Report report) const {
  const auto& interval = intervals_[index];
  const Timestamp from = intervals_.from(index);
  const BodyRates held = track.last_rates.value_or(BodyRates{});
  const BodyRates previous = track.last_rates.value_or(interval.rates);
  const double interval_s = to_seconds(interval.to - from);
  Timestamp time = from;
  const auto predict_until = [&](Timestamp to) {
    if (to == time) return;
    const double dt_s = to_seconds(to - time);
    if (interval.is_gap()) {
      filter.predict_gap(held, dt_s);
    } else {
      filter.predict({interval.rates, previous, interval_s, dt_s},
                     L::later(interval.nominal, to_seconds(time - from)));
    }
    time = to;
  };
  for (; next_frame < frames_.size() && frames_[next_frame].capture() <= until; ++next_frame) {
    const VisionPose vision = frames_[next_frame].vision_pose();
    predict_until(vision.capture);
    const Correction correction = filter.correct(vision.pose, vision.covariance);
    if (is_used(correction.verdict)) track.last_used = vision.capture;
    report(next_frame, correction);
  }
  predict_until(until);
  track.last_rates =
      interval.is_gap() ? settings_.filter.gap.rates(held, interval_s) : interval.rates;
}

template <class L, OdometryErrorModel E>
void DelayedFusion<L, E>::decide(FrameRecord& record, const Correction& correction) {
  record.nis = static_cast<float>(correction.nis);
  if (record.verdict == correction.verdict) return;
  if (record.verdict != PoseVerdict::kWaitsForOdometry) ++revised_;
  --pose_counts_.at(static_cast<std::size_t>(record.verdict));
  ++pose_counts_.at(static_cast<std::size_t>(correction.verdict));
  record.verdict = correction.verdict;
}

template <class L, OdometryErrorModel E>
Estimate DelayedFusion<L, E>::estimate_of(const Filter& filter, const Track& track,
                                          Timestamp time) const {
  const auto& state = filter.state();
  const BodyRates last = track.last_rates.value_or(BodyRates{});
  const OdometryStep step{last, last, 0.01, 0.01};
  return {time, state.pose, state.pose_covariance(),
          settings_.filter.odometry_error.corrected(step, state.odometry_error).rates};
}

template <class L, OdometryErrorModel E>
std::optional<Estimate> DelayedFusion<L, E>::estimate_at(Timestamp time) const {
  if (!has_time_ || time < horizon()) return std::nullopt;
  Filter filter = filter_;
  Track track = track_;
  if (time < now()) {
    const std::uint64_t index =
        time == horizon() ? intervals_.first() : intervals_.containing(time);
    std::uint64_t i = index - index % intervals_.block_length();
    const Snapshot& start = snapshots_[i / intervals_.block_length() % snapshots_.size()];
    filter.set_state(start.state);
    track = start.track;
    std::size_t next_frame = frames_.first_after(intervals_.from(i));
    const auto ignore = [](std::size_t, const Correction&) {};
    for (; i < index; ++i) run(filter, track, i, intervals_[i].to, next_frame, ignore);
    run(filter, track, index, time, next_frame, ignore);
  } else if (time > now()) {
    const BodyRates last = track.last_rates.value_or(BodyRates{});
    const double dt_s = to_seconds(time - now());
    Nominal nominal{};
    if (intervals_.end() > intervals_.first()) {
      const std::uint64_t index = intervals_.end() - 1;
      nominal = L::later(intervals_[index].nominal, to_seconds(now() - intervals_.from(index)));
    }
    filter.predict({last, last, dt_s, dt_s}, nominal);
  }
  if (!filter.state().has_started) return std::nullopt;
  return estimate_of(filter, track, time);
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
