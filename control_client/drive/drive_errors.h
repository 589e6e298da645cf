#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "control_client/drive/drive_log_reader.h"

namespace nadir::control_client {

/// Root mean square and largest distance of two poses over time.
struct DriveError {
  double position_rms_m = 0.0;
  double position_max_m = 0.0;
  double heading_rms_rad = 0.0;
};

/// How good a drive with a simulated robot was.
struct DriveErrors {
  std::string name;
  double duration_s = 0.0;
  DriveError fused;       ///< estimate against truth
  DriveError encoders;    ///< what encoders alone say against truth
  DriveError tracking;    ///< truth against the commanded trajectory, while it was followed
  double slowed_s = 0.0;  ///< time of being slowed down or stopped, the end apart
  double ticks = 0.0;
  double ticks_missed = 0.0;
};

/// Measures what is later than `from_s`.
DriveErrors measure_drive(const DriveRecord& record, double from_s = 1.0);

/// A table for people, and the same as JSON.
std::string error_table(const std::vector<DriveErrors>& drives);
nlohmann::json error_json(const std::vector<DriveErrors>& drives);

}  // namespace nadir::control_client
