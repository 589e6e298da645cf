#include "fusion/frame_history.h"

#include <algorithm>
#include <cassert>
#include <tuple>

namespace nadir::fusion {

FrameRecord::FrameRecord(const VisionPose& vision)
    : capture_(vision.capture),
      frame_(vision.frame),
      camera_(vision.camera),
      epoch_(vision.epoch),
      pose_(vision.pose),
      covariance_{vision.covariance(0, 0), vision.covariance(0, 1), vision.covariance(0, 2),
                  vision.covariance(1, 1), vision.covariance(1, 2), vision.covariance(2, 2)} {}

VisionPose FrameRecord::vision_pose() const {
  VisionPose vision{camera_, epoch_, frame_, capture_, pose_, {}};
  const auto& [xx, xy, xh, yy, yh, hh] = covariance_;
  vision.covariance << xx, xy, xh, xy, yy, yh, xh, yh, hh;
  return vision;
}

bool FrameRecord::is_before(const FrameRecord& other) const {
  return std::tie(capture_, camera_, epoch_, frame_) <
         std::tie(other.capture_, other.camera_, other.epoch_, other.frame_);
}

FrameHistory::FrameHistory(std::size_t capacity) : capacity_(capacity) {
  records_.reserve(capacity);
}

bool FrameHistory::knows(const VisionPose& vision) const {
  return std::any_of(records_.begin(), records_.end(),
                     [&](const FrameRecord& record) { return record.is_frame_of(vision); });
}

void FrameHistory::insert(const FrameRecord& record) {
  assert(!is_full());
  const auto place =
      std::upper_bound(records_.begin(), records_.end(), record,
                       [](const FrameRecord& a, const FrameRecord& b) { return a.is_before(b); });
  records_.insert(place, record);
}

void FrameHistory::forget_until(Timestamp time) {
  records_.erase(records_.begin(),
                 records_.begin() + static_cast<std::ptrdiff_t>(first_after(time)));
}

std::size_t FrameHistory::first_after(Timestamp time) const {
  const auto found = std::upper_bound(
      records_.begin(), records_.end(), time,
      [](Timestamp at, const FrameRecord& record) { return at < record.capture(); });
  return static_cast<std::size_t>(found - records_.begin());
}

}  // namespace nadir::fusion
