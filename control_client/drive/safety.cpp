#include "control_client/drive/safety.h"

namespace nadir::control_client {

using tracker::ClientMode;
using tracker::ClientReason;

const SafetyVerdict& Safety::update(const SafetyView& view, double dt_s) {
  Finding finding = blocking(view);
  const Finding doubt = worst(view);  // also while blocked: levels follow their quantities
  if (finding.level == Level::kFine) finding = doubt;
  if (finding.level == Level::kStop) {
    stand(finding.reason);
    return verdict_;
  }
  const bool stands = !verdict_.drives();
  if (stands && has_driven_) {
    fine_for_s_ += dt_s;
    if (fine_for_s_ < settings_.resume_after_s) return verdict_;
  }
  has_driven_ = true;
  if (view.trajectory_over) {
    verdict_ = {ClientMode::kFinished, ClientReason::kTrajectoryOver, 1.0};
  } else if (finding.level == Level::kSlow) {
    verdict_ = {ClientMode::kSlow, finding.reason, settings_.slow_pace};
  } else {
    verdict_ = {ClientMode::kDriving, ClientReason::kNone, 1.0};
  }
  return verdict_;
}

void Safety::stand(ClientReason reason) {
  fine_for_s_ = 0.0;
  ClientMode mode = has_driven_ ? ClientMode::kStopped : ClientMode::kStarting;
  if (reason == ClientReason::kEmergencyStop) mode = ClientMode::kEmergency;
  if (reason == ClientReason::kInterrupted) mode = ClientMode::kStopped;
  verdict_ = {mode, reason, 0.0};
}

// What allows no driving at all, the most urgent first.
Safety::Finding Safety::blocking(const SafetyView& view) const {
  const auto stop = [](ClientReason reason) { return Finding{Level::kStop, reason}; };
  if (view.emergency_stop) return stop(ClientReason::kEmergencyStop);
  if (view.interrupted) return stop(ClientReason::kInterrupted);
  if (!view.odometry_age_s || *view.odometry_age_s > settings_.odometry_silent_s) {
    return stop(ClientReason::kNoOdometry);
  }
  if (view.clock_jumped) return stop(ClientReason::kClockJump);
  if (!view.clock_known) return stop(ClientReason::kNoClock);
  if (!view.pose_age_s) return stop(ClientReason::kNoPose);
  if (has_driven_ && view.command_gap_s > settings_.command_gap_s) {
    return stop(ClientReason::kOther);
  }
  return {};
}

Safety::Finding Safety::worst(const SafetyView& view) {
  struct Quantity {
    double value;
    SafetyLimit limit;
    ClientReason reason;
  };
  const std::array<Quantity, kQuantities> quantities = {{
      {view.pose_age_s.value_or(0.0), settings_.pose_age_s, ClientReason::kPoseTooOld},
      {view.position_sigma_m, settings_.position_sigma_m, ClientReason::kUncertain},
      {view.heading_sigma_rad, settings_.heading_sigma_rad, ClientReason::kUncertain},
      {view.off_track_m, settings_.off_track_m, ClientReason::kOffTrack},
      {view.off_track_rad, settings_.off_track_rad, ClientReason::kOffTrack},
      {view.saturated_share, settings_.saturated_share, ClientReason::kSaturated},
  }};
  Finding finding;
  for (std::size_t i = 0; i < kQuantities; ++i) {
    const auto& [value, limit, reason] = quantities[i];
    Level& level = levels_[i];
    if (value > limit.stop) {
      level = Level::kStop;
    } else if (value > limit.slow && level == Level::kFine) {
      level = Level::kSlow;
    } else if (value < settings_.release * limit.slow) {
      level = Level::kFine;
    }
    if (level > finding.level) finding = {level, reason};
  }
  return finding;
}

}  // namespace nadir::control_client
