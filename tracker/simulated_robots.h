#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "tracker/console.h"
#include "tracker/truth_history.h"
#include "tracker/wire/value_streams.h"
#include "vision/synthetic/live_robots.h"

namespace nadir::tracker {

/// The simulated robots of the network, for a synthetic camera: what they publish of their true
/// poses is what it sees of them.
class SimulatedRobots : public vision::LiveRobots {
 public:
  /// hold: a robot not heard of for longer is gone. Throws WireError if DDS refuses.
  SimulatedRobots(const Participant& participant, std::chrono::nanoseconds hold, Console& console);

  /// Waits up to 50 ms for truth that is still on its way, so that a busy machine makes frames late
  /// and not wrong; for a robot that fell silent once, then no more.
  void at(vision::CaptureTime time, std::vector<vision::LiveRobot>& robots) override;
  void cannot_show(const vision::LiveRobot& robot) override;

 private:
  struct Known {
    std::string team;
    std::int32_t robot = 0;
    TruthHistory history;
    bool is_silent = false;  ///< was waited for in vain
  };

  void take(const WireSimulatedTruth& truth);
  bool all_known_at(std::int64_t time_ns) const;

  std::chrono::nanoseconds hold_;
  Console& console_;
  MessageLimiter messages_{std::chrono::seconds(10)};
  std::mutex mutex_;
  std::condition_variable news_;
  std::vector<Known> known_;
  SimulatedTruthReader reader_;  // last: its callback uses the others
};

}  // namespace nadir::tracker
