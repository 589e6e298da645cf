#pragma once

#include <chrono>
#include <cstdint>

namespace nadir::control_client {

/// When the periods of a loop begin, in absolute time: neither the loop's own work nor a late wake
/// shifts the later ones. Periods that were slept through are counted and never made up for: there
/// is no burst. The caller owns the clock and sleeps.
///
///     while (...) { sleep until scheduler.next(); periods = scheduler.arrive(now); work }
class TickScheduler {
 public:
  using Time = std::chrono::nanoseconds;

  /// The first period begins at `start`; period > 0.
  TickScheduler(Time start, Time period) : next_(start), period_(period) {}

  Time next() const { return next_; }
  Time period() const { return period_; }

  /// The caller woke at `now`. Returns how many periods have begun since it last did so: 1 in
  /// time, more when it slept through some, 0 where it is too early.
  std::int64_t arrive(Time now) {
    if (now < next_) return 0;
    const std::int64_t periods = (now - next_) / period_ + 1;
    next_ += periods * period_;
    return periods;
  }

 private:
  Time next_;
  Time period_;
};

}  // namespace nadir::control_client
