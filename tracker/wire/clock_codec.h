#pragma once

#include <cstdint>

#include "nadir_clock.h"  // written by idlc
#include "tracker/wire/clock_exchange.h"

namespace nadir::tracker {

/// A client's question as it arrived at a tracker.
struct ClockQuestion {
  std::uint64_t client = 0;
  std::uint64_t sequence = 0;
  std::int64_t t1_ns = 0;  ///< client's clock
  std::int64_t t2_ns = 0;  ///< tracker's clock; not on the wire
};

// False for times before 1970 or after 2200, and for an answer that left before its question came.

/// Leaves t2_ns alone.
bool decode(const nadir_wire_ClockRequest& sample, ClockQuestion* question);
/// Leaves t4_ns alone.
bool decode(const nadir_wire_ClockReply& sample, ClockExchange* exchange);

}  // namespace nadir::tracker
