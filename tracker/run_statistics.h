#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tracker/pose_report.h"

namespace nadir::tracker {

/// What one camera's run came to: counts over all frames, medians over the last kWindow of them.
class RunStatistics {
 public:
  static constexpr std::size_t kWindow = 8192;

  RunStatistics() { stages_.reserve(kWindow); }

  void add(const FrameReport& report);
  void add_skipped() { ++skipped_; }

  std::uint64_t frames() const { return frames_; }
  std::uint64_t skipped() const { return skipped_; }

  /// Medians stage by stage; zeros without frames.
  StageTimes median_stages() const;
  /// One line for a person: frames, skipped, robots and rejected candidates a frame, median stage
  /// times.
  std::string summary(const std::string& camera) const;

 private:
  std::uint64_t frames_ = 0;
  std::uint64_t skipped_ = 0;
  std::uint64_t robots_ = 0;
  std::uint64_t rejected_ = 0;
  std::vector<StageTimes> stages_;  // a ring once it is full
};

}  // namespace nadir::tracker
