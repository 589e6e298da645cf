#pragma once

#include <optional>

#include "control_client/drive/onboard_fusion.h"

namespace nadir::control_client {

/// Joins the short intervals of the wheels' encoders to one for each tick: the filter needs no
/// more, and it costs less.
class OdometryMerger {
 public:
  /// Returns what had been joined before, if this interval does not follow it.
  std::optional<OdometryInterval> add(const OdometryInterval& next);
  /// What was joined since the last call; nothing if there was none.
  std::optional<OdometryInterval> take();

 private:
  std::optional<OdometryInterval> joined_;
};

}  // namespace nadir::control_client
