#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

#include "tracker/wire/simulated_truth.h"
#include "vision/synthetic/robot_path.h"

namespace nadir::tracker {

/// The last two seconds of one simulated robot's truth, from which it is known where the robot was
/// at any time between: samples come at the simulation's ticks, frames are exposed at others.
class TruthHistory {
 public:
  /// Samples may come in any order; another epoch is another run and forgets all before it.
  void add(const WireSimulatedTruth& truth);

  /// Where the robot was and how it moved. Between two samples by the cubic that has the poses and
  /// velocities of both (its error is at most x'''' dt^4 / 384: 6e-11 m on a circle of 0.3 m at 1
  /// m/s with 5 ms between samples), if they are no more than `hold` apart. After the newest one
  /// straight on for 50 ms, then at rest. Nothing before the first sample, and nothing where no
  /// sample is within `hold` before.
  std::optional<vision::RobotMotion> at(std::int64_t time_ns, std::chrono::nanoseconds hold) const;

  /// Time of the newest sample; nothing without samples.
  std::optional<std::int64_t> newest_ns() const;

 private:
  std::uint64_t epoch_ = 0;
  std::deque<WireSimulatedTruth> samples_;  ///< by time
};

}  // namespace nadir::tracker
