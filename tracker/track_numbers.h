#pragma once

#include <chrono>
#include <vector>

#include "vision/frame.h"

namespace nadir::tracker {

/// Numbers for anonymous robots: 0, 1, 2 and so on, the lowest free one first. A number that was
/// given back rests before it is used again, so that nobody takes a new robot for the one that is
/// gone; and as it is used again in the end, a long run does not fill its listeners with ever new
/// robots.
class TrackNumbers {
 public:
  static constexpr std::chrono::seconds kRest{10};

  TrackNumbers() { slots_.reserve(256); }

  int take(vision::CaptureTime now) {
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      if (slots_[i].free && now - slots_[i].free_since >= kRest) {
        slots_[i].free = false;
        return static_cast<int>(i);
      }
    }
    slots_.push_back({});
    return static_cast<int>(slots_.size()) - 1;
  }

  void give_back(int number, vision::CaptureTime now) {
    slots_[static_cast<std::size_t>(number)] = {true, now};
  }

  void clear() { slots_.clear(); }

 private:
  struct Slot {
    bool free = false;
    vision::CaptureTime free_since{};
  };
  std::vector<Slot> slots_;
};

}  // namespace nadir::tracker
