#pragma once

// The functions of DelayedFusion that run the filter along the recorded history; included by its
// header alone.

#include <cstddef>
#include <cstdint>
#include <optional>

#include "fusion/delayed_fusion.h"

namespace nadir::fusion {

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
  const double previous_s = track.last_rates ? track.last_interval_s : interval_s;
  Timestamp time = from;
  const auto predict_until = [&](Timestamp to) {
    if (to == time) return;
    const double dt_s = to_seconds(to - time);
    if (interval.is_gap()) {
      filter.predict_gap(held, dt_s);
    } else {
      filter.predict({interval.rates, previous, interval_s, dt_s, previous_s},
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
  track.last_interval_s = interval_s;
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

}  // namespace nadir::fusion
