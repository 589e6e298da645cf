#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fusion/timestamp.h"
#include "fusion/verdict.h"
#include "fusion/vision_pose.h"

namespace nadir::fusion {

/// A pose in the history, with what was decided of it. Half of its covariance is kept.
class FrameRecord {
 public:
  explicit FrameRecord(const VisionPose& vision);

  VisionPose vision_pose() const;
  Timestamp capture() const { return capture_; }
  bool is_frame_of(const VisionPose& vision) const {
    return camera_ == vision.camera && epoch_ == vision.epoch && frame_ == vision.frame;
  }
  /// Order of use: capture time, then camera, then the frame's number.
  bool is_before(const FrameRecord& other) const;

  PoseVerdict verdict = PoseVerdict::kWaitsForOdometry;
  float nis = 0.0F;

 private:
  Timestamp capture_;
  std::uint64_t frame_;
  std::uint32_t camera_;
  std::uint32_t epoch_;
  PlanarPose pose_;
  std::array<double, 6> covariance_;  // xx xy xh yy yh hh
};

/// The poses in the history in the order of use; room for a fixed number.
class FrameHistory {
 public:
  explicit FrameHistory(std::size_t capacity);

  bool is_full() const { return records_.size() == capacity_; }
  bool knows(const VisionPose& vision) const;
  /// Not when full.
  void insert(const FrameRecord& record);
  /// Forgets what was captured at this time or before.
  void forget_until(Timestamp time);
  void clear() { records_.clear(); }

  /// Index of the first record that was captured after this time.
  std::size_t first_after(Timestamp time) const;
  std::size_t size() const { return records_.size(); }
  FrameRecord& operator[](std::size_t index) { return records_[index]; }
  const FrameRecord& operator[](std::size_t index) const { return records_[index]; }
  std::span<const FrameRecord> records() const { return records_; }

 private:
  std::size_t capacity_;
  std::vector<FrameRecord> records_;
};

}  // namespace nadir::fusion
