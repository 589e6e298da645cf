#pragma once

#include <cstdint>
#include <optional>

#include "vision/synthetic/scene.h"

namespace nadir::vision {

/// What becomes of the frames of a camera behind a slow or lossy link, as a scene's `delivery`
/// says. A pure function of delivery, seed and frame number.
class Delivery {
 public:
  Delivery(SceneDelivery delivery, double rate_hz, std::uint64_t seed);

  /// Time from the middle of a frame's exposure to its delivery, s; nothing for a frame that is
  /// lost.
  std::optional<double> delay_s(std::uint64_t frame_number) const;
  /// True while the link is down: all frames are lost.
  bool is_blacked_out(std::uint64_t frame_number) const;

 private:
  SceneDelivery delivery_;
  double rate_hz_;
  std::uint64_t seed_;
};

}  // namespace nadir::vision
