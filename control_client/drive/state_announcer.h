#pragma once

#include <optional>
#include <string>

#include "control_client/drive/safety.h"
#include "fusion/timestamp.h"

namespace nadir::control_client {

/// Lines for people about what a robot does and why: one when that changes, but not more than one
/// in half a second, whatever flickers; the latest wins.
class StateAnnouncer {
 public:
  explicit StateAnnouncer(std::string robot) : robot_(std::move(robot)) {}

  /// The line to print now, if there is one.
  std::optional<std::string> line(const SafetyVerdict& verdict, fusion::Timestamp now);

 private:
  std::string robot_;
  bool has_spoken_ = false;
  fusion::Timestamp spoke_at_{0};
  tracker::ClientMode mode_ = tracker::ClientMode::kStarting;
  tracker::ClientReason reason_ = tracker::ClientReason::kNone;
};

}  // namespace nadir::control_client
