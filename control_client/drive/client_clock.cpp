#include "control_client/drive/client_clock.h"

#include <chrono>
#include <cmath>

#include "tracker/wire/clock_exchange.h"

namespace nadir::control_client {

using fusion::Timestamp;

ClientClock::ClientClock(const ClockError& error) : rate_(1e-6 * error.drift_ppm) {
  // Whoever is interrupted between two clocks reads them far apart: the closest of several.
  Timestamp closest = Timestamp::max();
  for (int i = 0; i < 10; ++i) {
    const Timestamp before = steady_now();
    const Timestamp wall(tracker::system_clock_ns());
    const Timestamp after = steady_now();
    if (after - before >= closest) continue;
    closest = after - before;
    steady_start_ = before + closest / 2;
    wall_start_ = wall;
  }
  start_ = wall_start_ + fusion::from_seconds(error.offset_s);
}

Timestamp ClientClock::steady_now() {
  return std::chrono::duration_cast<Timestamp>(std::chrono::steady_clock::now().time_since_epoch());
}

Timestamp ClientClock::at(Timestamp steady) const {
  const Timestamp passed = steady - steady_start_;
  return start_ + passed + Timestamp(std::llround(rate_ * static_cast<double>(passed.count())));
}

Timestamp ClientClock::true_wall(Timestamp time) const {
  const double passed_ns = static_cast<double>((time - start_).count());
  return wall_start_ + (time - start_) - Timestamp(std::llround(passed_ns * rate_ / (1.0 + rate_)));
}

}  // namespace nadir::control_client
