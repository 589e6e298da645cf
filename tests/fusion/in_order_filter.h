#pragma once

#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "tests/fusion/fusion_feed.h"

namespace nadir::fusion::test {

using FrameId = std::tuple<std::uint32_t, std::uint64_t>;  ///< camera, frame

inline FrameId id_of(const VisionPose& vision) { return {vision.camera, vision.frame}; }

/// What a filter says that waited for everything and then took it in the order of capture.
template <class Linearization, class OdometryError>
struct InOrderResult {
  using State = typename PoseFilter<Linearization, OdometryError>::State;
  std::vector<State> after_sample;
  std::map<FrameId, PoseVerdict> verdicts;
};

/// The reference of the replay: no history, no replay, one pass. Written on the filter alone.
template <class Linearization, class OdometryError>
InOrderResult<Linearization, OdometryError> run_in_order(
    const Feed& feed, const typename PoseFilter<Linearization, OdometryError>::Settings& settings,
    bool starts_known) {
  PoseFilter<Linearization, OdometryError> filter(settings);
  if (starts_known) filter.start(feed.expected_start, feed.start_covariance);
  InOrderResult<Linearization, OdometryError> result;
  std::optional<BodyRates> last;
  double last_s = 0.0;
  Timestamp time = feed.odometry.front().from;
  std::size_t next = 0;
  while (next < feed.frames.size() && feed.frames[next].vision.capture <= time) ++next;

  // One piece of time with the same rates, or with none.
  const auto pass = [&](Timestamp from, Timestamp to, const OdometrySample* sample) {
    const auto predict_until = [&](Timestamp until) {
      if (until == time) return;
      const double dt_s = to_seconds(until - time);
      if (sample == nullptr) {
        filter.predict_gap(last.value_or(BodyRates{}), dt_s);
      } else {
        typename Linearization::Nominal nominal{};
        if constexpr (requires { nominal.rates; }) nominal = sample->nominal;
        filter.predict({sample->rates, last.value_or(sample->rates), to_seconds(to - from), dt_s,
                        last ? last_s : to_seconds(to - from)},
                       Linearization::later(nominal, to_seconds(time - from)));
      }
      time = until;
    };
    for (; next < feed.frames.size() && feed.frames[next].vision.capture <= to; ++next) {
      const VisionPose& vision = feed.frames[next].vision;
      predict_until(vision.capture);
      result.verdicts[id_of(vision)] = filter.correct(vision.pose, vision.covariance).verdict;
    }
    predict_until(to);
    last = sample == nullptr ? settings.gap.rates(last.value_or(BodyRates{}), to_seconds(to - from))
                             : sample->rates;
    last_s = to_seconds(to - from);
  };
  for (const OdometrySample& sample : feed.odometry) {
    if (sample.from > time) pass(time, sample.from, nullptr);
    pass(sample.from, sample.to, &sample);
    result.after_sample.push_back(filter.state());
  }
  return result;
}

}  // namespace nadir::fusion::test
