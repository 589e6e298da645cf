#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "fusion/clock_offset.h"
#include "fusion/timestamp.h"
#include "tracker/wire/clock_exchange.h"

namespace nadir::control_client {

/// The clocks of all trackers that were heard of, as seen from the robot's. Each run of a tracker
/// (epoch) has its own: after a restart, or with a second tracker on another machine, nothing of
/// the old one is taken over. The four that were heard of last are remembered.
class TrackerClocks {
 public:
  /// An exchange whose client side was stamped by the robot's clock. True if it shows that a clock
  /// was set.
  bool add(const tracker::ClockExchange& exchange);

  /// A stamp of that tracker on the robot's clock. Nothing while its clock is not known, or
  /// doubtful because the last exchange contradicts those before.
  std::optional<fusion::Timestamp> robot_time(std::uint64_t epoch, std::int64_t stamp_ns) const;

  /// The clock that was heard of last, at a time of the robot's.
  std::optional<fusion::ClockReading> reading(fusion::Timestamp robot_time) const;

 private:
  struct Clock {
    std::uint64_t epoch = 0;
    std::uint64_t heard = 0;  // when, in exchanges; 0: free
    bool doubtful = false;
    fusion::ClockOffset offset;
  };

  const Clock* find(std::uint64_t epoch) const;
  Clock& clock_of(std::uint64_t epoch);

  std::array<Clock, 4> clocks_;
  std::uint64_t exchanges_ = 0;
  std::uint64_t latest_epoch_ = 0;
};

}  // namespace nadir::control_client
