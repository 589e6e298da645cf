#include "control_client/drive/tracker_clocks.h"

#include <algorithm>

namespace nadir::control_client {

using fusion::ClockVerdict;
using fusion::Timestamp;

bool TrackerClocks::add(const tracker::ClockExchange& exchange) {
  Clock& clock = clock_of(exchange.epoch);
  const ClockVerdict verdict = clock.offset.add({.robot_sent = Timestamp(exchange.t1_ns),
                                                 .server_received = Timestamp(exchange.t2_ns),
                                                 .server_sent = Timestamp(exchange.t3_ns),
                                                 .robot_received = Timestamp(exchange.t4_ns)});
  clock.heard = ++exchanges_;
  clock.doubtful = verdict == ClockVerdict::kContradicts;
  latest_epoch_ = exchange.epoch;
  return verdict == ClockVerdict::kStepped;
}

std::optional<Timestamp> TrackerClocks::robot_time(std::uint64_t epoch,
                                                   std::int64_t stamp_ns) const {
  const Clock* clock = find(epoch);
  if (clock == nullptr || clock->doubtful) return std::nullopt;
  return clock->offset.robot_time(Timestamp(stamp_ns));
}

std::optional<fusion::ClockReading> TrackerClocks::reading(Timestamp robot_time) const {
  const Clock* latest = find(latest_epoch_);
  return latest == nullptr ? std::nullopt : latest->offset.at(robot_time);
}

const TrackerClocks::Clock* TrackerClocks::find(std::uint64_t epoch) const {
  const auto found = std::ranges::find_if(
      clocks_, [&](const Clock& clock) { return clock.heard > 0 && clock.epoch == epoch; });
  return found == clocks_.end() ? nullptr : &*found;
}

TrackerClocks::Clock& TrackerClocks::clock_of(std::uint64_t epoch) {
  const auto known = std::ranges::find_if(
      clocks_, [&](const Clock& clock) { return clock.heard > 0 && clock.epoch == epoch; });
  if (known != clocks_.end()) return *known;
  Clock& oldest = *std::ranges::min_element(clocks_, {}, &Clock::heard);
  oldest = Clock{};
  oldest.epoch = epoch;
  return oldest;
}

}  // namespace nadir::control_client
