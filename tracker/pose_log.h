#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <mutex>

#include "tracker/pose_report.h"

namespace nadir::tracker {

/// Writes one JSON object of the frame, without the line's end, behind what `line` holds:
///
///     {"frame": 0, "camera": "cam0", "capture_ns": 1700000000000000000,
///      "stages_us": {"read": 1.0, "detect": 1.0, "map": 1.0, "total": 2.0},
///      "robots": [{"id": 3, "team": "blue", "x_m": 0.1, "y_m": 0.2, "heading_rad": 1.0,
///                  "covariance": [9 numbers, row-major, x y heading], "u_px": 320.1, "v_px":
///                  240.2, "pixels": [55, 48], "confidence": 0.98}],
///      "rejected": [{"u_px": 1.0, "v_px": 2.0, "reason": "no heading marker"}]}
///
/// and "rejected_not_listed": n behind it where there were too many to list. Poses have 9 decimals
/// (1 nm, 1 nrad), covariances 10 significant digits, pixels 4 decimals. A number that is not
/// finite is written as null, as JSON knows no other.
void append_json(const FrameReport& report, fmt::memory_buffer& line);

/// A file of JSON lines, one for each frame, also where no robot is seen. Several cameras may share
/// one.
class PoseLog {
 public:
  /// Replaces the file; "-" is the standard output. Throws InputError if it cannot be written.
  explicit PoseLog(const std::filesystem::path& file);
  PoseLog(const PoseLog&) = delete;
  PoseLog& operator=(const PoseLog&) = delete;
  ~PoseLog();

  /// Adds one line; a line is never split between cameras. Allocates nothing once lines have their
  /// length. False if it could not be written (disk full, reader gone).
  bool write(const FrameReport& report);
  /// Hands over to the system what was written. False if it could not.
  bool flush();

 private:
  std::mutex mutex_;
  std::FILE* file_ = nullptr;
  bool owns_file_ = false;
  fmt::memory_buffer line_;
};

}  // namespace nadir::tracker
