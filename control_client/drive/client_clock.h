#pragma once

#include <cstdint>

#include "fusion/timestamp.h"

namespace nadir::control_client {

/// How wrong the robot's clock is, on purpose.
struct ClockError {
  double offset_s = 0.0;   ///< ahead of the machine's clock
  double drift_ppm = 0.0;  ///< and runs faster by so much
};

/// The robot's wall clock: the machine's at the start, carried on by its steady clock, so that
/// nobody who sets the machine's clock disturbs a robot that drives. May be wrong on purpose.
/// Thread-safe.
class ClientClock {
 public:
  explicit ClientClock(const ClockError& error = {});

  fusion::Timestamp now() const { return at(steady_now()); }
  static fusion::Timestamp steady_now();
  /// A time of the steady clock on this clock.
  fusion::Timestamp at(fusion::Timestamp steady) const;
  /// A time of this clock on the machine's wall clock, without the error.
  fusion::Timestamp true_wall(fusion::Timestamp time) const;

 private:
  double rate_;                     // of this clock against the steady one, minus 1
  fusion::Timestamp steady_start_;  // and at the same moment
  fusion::Timestamp wall_start_;    // the machine's wall clock
  fusion::Timestamp start_;         // this clock
};

}  // namespace nadir::control_client
