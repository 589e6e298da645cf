#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "control_client/drive/drive_core.h"
#include "fusion/planar_pose.h"

namespace nadir::control_client {

/// What a drive was, a row a tick, as CSV: see data/README.md for the columns. Without a simulated
/// robot the columns of the truth are not there.
class DriveLog {
 public:
  /// Throws std::runtime_error if the file cannot be written.
  DriveLog(const std::filesystem::path& file, bool has_truth);

  /// After a tick of the core at `now`; the truth is that of the same moment.
  void write(fusion::Timestamp now, const DriveCore& core,
             const std::optional<fusion::PlanarPose>& truth);
  /// Throws std::runtime_error if something could not be written.
  void finish();

 private:
  std::filesystem::path file_;
  std::ofstream stream_;
  bool has_truth_;
  std::int64_t start_ns_ = 0;
};

}  // namespace nadir::control_client
