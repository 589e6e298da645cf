#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fusion/body_rates.h"
#include "fusion/timestamp.h"

namespace nadir::fusion {

/// The last intervals of odometry, end to end, in a ring of fixed size. Intervals are numbered from
/// the first that ever came; whole blocks of them are forgotten at a time, so that a block's start
/// can be where a replay begins.
template <class Nominal>
class IntervalHistory {
 public:
  struct Interval {
    Timestamp to{0};
    BodyRates rates;  ///< mean; not finite in a gap, where nothing was measured
    [[no_unique_address]] Nominal nominal;

    bool is_gap() const { return !rates.is_finite(); }
  };

  IntervalHistory(std::size_t blocks, std::size_t block_length)
      : block_length_(block_length), ring_(blocks * block_length) {
    assert(blocks >= 2 && block_length >= 1);
  }

  /// Forgets all; the next interval begins at `from`.
  void restart(Timestamp from) {
    first_ = end_ = 0;
    oldest_ = newest_ = from;
  }

  bool is_full() const { return end_ - first_ == ring_.size(); }

  void push(const Interval& interval) {
    assert(!is_full() && interval.to > newest_);
    ring_[slot(end_++)] = interval;
    newest_ = interval.to;
  }

  bool has_more_than_a_block() const { return end_ - first_ > block_length_; }

  void forget_block() {
    assert(has_more_than_a_block());
    first_ += block_length_;
    oldest_ = ring_[slot(first_ - 1)].to;
  }

  std::uint64_t first() const { return first_; }
  std::uint64_t end() const { return end_; }
  std::size_t block_length() const { return block_length_; }
  Timestamp oldest() const { return oldest_; }  ///< where the first interval begins
  Timestamp newest() const { return newest_; }  ///< where the last one ends

  const Interval& operator[](std::uint64_t index) const { return ring_[slot(index)]; }
  Timestamp from(std::uint64_t index) const {
    return index == first_ ? oldest_ : (*this)[index - 1].to;
  }

  /// The interval with from < time <= to; oldest() < time <= newest().
  std::uint64_t containing(Timestamp time) const {
    assert(time > oldest_ && time <= newest_);
    std::uint64_t low = first_;
    std::uint64_t high = end_ - 1;
    while (low < high) {
      const std::uint64_t middle = low + (high - low) / 2;
      if ((*this)[middle].to < time) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low;
  }

 private:
  std::size_t slot(std::uint64_t index) const {
    return static_cast<std::size_t>(index % ring_.size());
  }

  std::size_t block_length_;
  std::vector<Interval> ring_;
  std::uint64_t first_ = 0;
  std::uint64_t end_ = 0;
  Timestamp oldest_{0};
  Timestamp newest_{0};
};

}  // namespace nadir::fusion
