#pragma once

#include <string>
#include <vector>

#include "control_client/drive/drive_errors.h"

namespace nadir::bench {

/// Robots that drive by what nadir-tracker sees of them, all in real processes over loopback DDS.
struct DriveScenario {
  std::string name;
  int robots = 3;
  double duration_s = 60.0;
  double packet_loss = 0.0;
  bool kills_tracker = false;   ///< in the middle, and starts it again at once
  double blackout_s = 0.0;      ///< in the middle
  double memory_every_s = 0.0;  ///< 0: memory at the end only
};

/// What a process took.
struct ProcessCost {
  double cpu_share = 0.0;  ///< of one core
  double memory_mb = 0.0;  ///< resident, at the end
};

/// Resident memory of all processes at one time, MB.
struct MemorySample {
  double time_s = 0.0;
  double tracker_mb = 0.0;
  double client_mb = 0.0;  ///< the first client's
};

struct DriveResult {
  DriveScenario scenario;
  std::vector<control_client::DriveErrors> drives;
  ProcessCost tracker;
  ProcessCost client;  ///< mean of all
  std::vector<MemorySample> memory;

  double ticks_missed_share() const;
  /// Root mean square and largest over all robots, estimate against truth.
  control_client::DriveError fused() const;
};

/// Runs it in real time. Throws std::runtime_error if a process fails.
DriveResult run_drive(const DriveScenario& scenario);

}  // namespace nadir::bench
