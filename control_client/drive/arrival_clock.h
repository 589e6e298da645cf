#pragma once

#include <optional>

#include "fusion/timestamp.h"

namespace nadir::control_client {

/// The difference between the receiver's clock and a sender's that never answers: nothing arrives
/// before it was stamped, so the smallest difference of arrival and stamp is the clocks' difference
/// plus the shortest way. The smallest of the last 10 to 20 s counts; a difference that stays far
/// above it (half a second of samples later than 50 ms), or one far below, is a clock that was set.
///
/// The shift stays as it is while it moves by less than a millisecond: stamps that are shifted by
/// it keep following each other.
class ArrivalClock {
 public:
  /// A stamp of the sender that arrives now. Returns what to add to the sender's stamps.
  fusion::Timestamp arrived(fusion::Timestamp stamp, fusion::Timestamp now);

 private:
  void restart(fusion::Timestamp difference, fusion::Timestamp now);

  std::optional<fusion::Timestamp> shift_;
  fusion::Timestamp smallest_before_{0};  // of the span before
  fusion::Timestamp smallest_{0};         // of this span
  fusion::Timestamp span_began_{0};
  std::optional<fusion::Timestamp> late_since_;
  fusion::Timestamp smallest_late_{0};
};

}  // namespace nadir::control_client
