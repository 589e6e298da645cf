#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <opencv2/core.hpp>
#include <stop_token>
#include <utility>
#include <vector>

#include "tracker/pose_report.h"

namespace nadir::tracker {

/// A finished frame on its way to the log and the overlay pictures.
struct FinishedFrame {
  std::size_t camera = 0;  ///< index of the camera
  FrameReport report;
  cv::Mat image;  ///< empty unless overlays are drawn
};

/// From the cameras' threads to the one that writes files. Bounded: a camera in real time drops the
/// oldest frame, which is counted; a recording waits, as its every frame shall be written. Frames
/// are swapped in and out, so that their memory is used again.
class ReportQueue {
 public:
  /// capacity: at least 1.
  explicit ReportQueue(std::size_t capacity) : slots_(capacity) {}

  /// Swaps `frame` in; it becomes some earlier one. Drops the oldest if the queue is full.
  void push_or_drop(FinishedFrame& frame) {
    const std::lock_guard lock(mutex_);
    if (size_ == slots_.size()) {
      first_ = (first_ + 1) % slots_.size();
      --size_;
      ++dropped_;
    }
    put(frame);
  }

  /// Swaps `frame` in as soon as there is room. False if a stop was asked for before.
  bool push_or_wait(FinishedFrame& frame, const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    if (!room_.wait(lock, stop, [this] { return size_ < slots_.size(); })) return false;
    put(frame);
    return true;
  }

  /// Swaps the oldest frame out; waits for one at most `timeout`. False if there was none.
  bool pop(FinishedFrame& frame, std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    if (!filled_.wait_for(lock, timeout, [this] { return size_ > 0; })) return false;
    std::swap(slots_[first_], frame);
    first_ = (first_ + 1) % slots_.size();
    --size_;
    room_.notify_one();
    return true;
  }

  std::uint64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  void put(FinishedFrame& frame) {
    std::swap(slots_[(first_ + size_) % slots_.size()], frame);
    ++size_;
    filled_.notify_one();
  }

  mutable std::mutex mutex_;
  std::condition_variable_any filled_;
  std::condition_variable_any room_;
  std::vector<FinishedFrame> slots_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace nadir::tracker
