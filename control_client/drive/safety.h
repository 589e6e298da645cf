#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "tracker/wire/client_state.h"

namespace nadir::control_client {

/// A quantity that is fine while it is small. Beyond `slow` the robot is slowed down, beyond `stop`
/// it stands; either ends below `release` times `slow`.
struct SafetyLimit {
  double slow = 0.0;
  double stop = 0.0;
};

/// When the robot may drive.
struct SafetySettings {
  SafetyLimit pose_age_s{0.5, 1.5};  ///< since the capture of the newest pose that was believed
  SafetyLimit position_sigma_m{0.03, 0.10};  ///< of the worse direction
  SafetyLimit heading_sigma_rad{0.15, 0.50};
  SafetyLimit off_track_m{0.10, 0.30};  ///< from the nominal motion
  SafetyLimit off_track_rad{0.5, 1.2};
  /// Share of the last second in which a motor was at its limit. Never reached: only slows down.
  SafetyLimit saturated_share{0.5, 2.0};
  double odometry_silent_s = 0.2;  ///< beyond, the robot stands
  double command_gap_s = 0.1;      ///< commands came so late that the base stopped by itself
  double release = 0.8;
  double resume_after_s =
      0.5;                 ///< everything is fine for so long before a robot that stands drives
  double slow_pace = 0.4;  ///< of the trajectory's time
};

/// What there is to judge at a tick.
struct SafetyView {
  bool emergency_stop = false;
  bool interrupted = false;              ///< the client was asked to end
  bool clock_known = false;              ///< the tracker's
  bool clock_jumped = false;             ///< since the last tick, any clock
  std::optional<double> odometry_age_s;  ///< nothing before the first
  std::optional<double> pose_age_s;      ///< nothing before the first
  double position_sigma_m = 0.0;
  double heading_sigma_rad = 0.0;
  double off_track_m = 0.0;  ///< 0 while the robot is not meant to move
  double off_track_rad = 0.0;
  double saturated_share = 0.0;
  double command_gap_s = 0.0;  ///< since the last command
  bool trajectory_over = false;
};

struct SafetyVerdict {
  tracker::ClientMode mode = tracker::ClientMode::kStarting;
  tracker::ClientReason reason = tracker::ClientReason::kNone;
  double pace = 0.0;  ///< at which the trajectory's time may run

  /// Whether the robot follows its plan; otherwise it stands.
  bool drives() const {
    return mode == tracker::ClientMode::kDriving || mode == tracker::ClientMode::kSlow ||
           mode == tracker::ClientMode::kFinished;
  }
};

/// Decides tick by tick whether the robot drives, drives slowly or stands, and why. Time comes from
/// outside; nothing else is remembered than the present levels and how long all has been fine.
class Safety {
 public:
  explicit Safety(const SafetySettings& settings) : settings_(settings) {}

  /// dt_s > 0 after the last tick.
  const SafetyVerdict& update(const SafetyView& view, double dt_s);
  const SafetyVerdict& verdict() const { return verdict_; }

 private:
  enum class Level : std::uint8_t { kFine, kSlow, kStop };
  struct Finding {
    Level level = Level::kFine;
    tracker::ClientReason reason = tracker::ClientReason::kNone;
  };
  static constexpr std::size_t kQuantities = 6;

  Finding worst(const SafetyView& view);
  Finding blocking(const SafetyView& view) const;
  void stand(tracker::ClientReason reason);

  SafetySettings settings_;
  SafetyVerdict verdict_;
  std::array<Level, kQuantities> levels_ = {};
  bool has_driven_ = false;
  double fine_for_s_ = 0.0;
};

}  // namespace nadir::control_client
