#pragma once

#include <chrono>
#include <optional>

#include "fusion/body_rates.h"
#include "fusion/timestamp.h"
#include "fusion/verdict.h"

namespace nadir::fusion {

/// Which odometry is believed.
struct OdometryCheck {
  /// Gaps and overlaps up to this are jitter of the stamps: the samples are joined.
  std::chrono::nanoseconds join_tolerance = std::chrono::milliseconds(2);
  std::chrono::nanoseconds longest_interval = std::chrono::milliseconds(500);
  std::chrono::nanoseconds longest_gap = std::chrono::seconds(60);
  /// So many samples in a row that follow each other, but not what is known: the clock was set.
  int restart_after = 10;
  double fastest_mps = 50.0;
  double fastest_radps = 500.0;
};

/// Why odometry over [from, to] cannot be used whenever it comes, or nothing.
std::optional<OdometryVerdict> reason_to_refuse(Timestamp from, Timestamp to,
                                                const BodyRates& mean_rates,
                                                const OdometryCheck& check);

/// Compares the stamps of odometry with the time that is known, and notices when the clock was set.
class OdometryClock {
 public:
  /// kUsed, kUsedAfterGap, kBehind, kAhead or, if this sample is the last of enough that were
  /// behind or ahead, kClockRestarted.
  OdometryVerdict compare(Timestamp now, Timestamp from, Timestamp to, const OdometryCheck& check);

  /// Where the run of samples off the known time began.
  Timestamp run_began() const { return run_began_; }

 private:
  int off_time_ = 0;
  Timestamp run_began_{0};
  Timestamp last_to_{0};
};

}  // namespace nadir::fusion
