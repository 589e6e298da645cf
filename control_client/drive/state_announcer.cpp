#include "control_client/drive/state_announcer.h"

namespace nadir::control_client {

std::optional<std::string> StateAnnouncer::line(const SafetyVerdict& verdict,
                                                fusion::Timestamp now) {
  constexpr fusion::Timestamp kPause = std::chrono::milliseconds(500);
  const bool is_new = !has_spoken_ || verdict.mode != mode_ || verdict.reason != reason_;
  if (!is_new || (has_spoken_ && now - spoke_at_ < kPause)) return std::nullopt;
  has_spoken_ = true;
  spoke_at_ = now;
  mode_ = verdict.mode;
  reason_ = verdict.reason;
  std::string line = robot_ + ": " + tracker::name_of(mode_);
  if (reason_ == tracker::ClientReason::kOther) return line + " (commands came too late)";
  if (reason_ != tracker::ClientReason::kNone)
    line += std::string(" (") + tracker::name_of(reason_) + ")";
  return line;
}

}  // namespace nadir::control_client
