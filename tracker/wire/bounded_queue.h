#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

namespace nadir::tracker {

/// Between the thread that receives and the one that uses. A full queue drops its oldest entry and
/// counts it. Its slots are made once and keep their memory.
template <typename Value>
class BoundedQueue {
 public:
  /// capacity: at least 1.
  explicit BoundedQueue(std::size_t capacity) : slots_(capacity > 0 ? capacity : 1) {}

  /// Swaps the value in; `value` becomes some earlier one.
  void push(Value* value) {
    {
      const std::lock_guard lock(mutex_);
      if (size_ == slots_.size()) {
        first_ = (first_ + 1) % slots_.size();
        --size_;
        ++dropped_;
      }
      std::swap(slots_[(first_ + size_) % slots_.size()], *value);
      ++size_;
    }
    filled_.notify_one();
  }

  /// Swaps the oldest value out; waits for one at most `timeout`. False if there was none.
  bool pop(Value* value, std::chrono::nanoseconds timeout) {
    std::unique_lock lock(mutex_);
    if (!filled_.wait_for(lock, timeout, [this] { return size_ > 0; })) return false;
    std::swap(slots_[first_], *value);
    first_ = (first_ + 1) % slots_.size();
    --size_;
    return true;
  }

  std::uint64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable filled_;
  std::vector<Value> slots_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace nadir::tracker
