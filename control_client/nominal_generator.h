#pragma once

#include <optional>

#include "control_client/command_shaping.h"
#include "control_client/control_parameters.h"
#include "control_client/nominal_motion.h"
#include "control_client/pseudo_differentiator.h"
#include "control_client/trajectory.h"

namespace nadir::control_client {

/// How the nominal motion is made of the commanded trajectory.
enum class NominalKind {
  kFiltered,  ///< pseudo-differentiator of constant bandwidth (S0 eq 4): the papers' way, late
  kExact,     ///< the trajectory's own pose and velocity: no lag
  kShaped,    ///< bandwidth that keeps the motors within their range
};

struct NominalSettings {
  NominalKind kind = NominalKind::kFiltered;
  /// The command is taken so much ahead of time. The filter's ramp lag less half a tick makes up
  /// for its lag: 2 zeta / w - tick_s / 2.
  double preview_s = 0.0;
  ShapingParameters shaping;
};

/// The nominal motion tick by tick, from rest at the trajectory's start.
class NominalGenerator {
 public:
  /// `model` outlives the generator.
  NominalGenerator(const RobotModel& model, const ControlParameters& control,
                   const NominalSettings& settings, TrajectoryPtr trajectory);

  /// One tick later. The command of the new tick acts since the tick before.
  void advance() { advance(tick_s_, 1.0); }

  /// dt_s > 0 later (a multiple of the tick where the motion is shaped), with the trajectory's time
  /// running `pace` times as fast as the clock, 0 to 1: the same path, more slowly.
  void advance(double dt_s, double pace);

  const NominalMotion& motion() const { return motion_; }
  /// Of the trajectory.
  double time_s() const { return began_s_ + ticks_ * tick_s_; }

 private:
  NominalSettings settings_;
  TrajectoryPtr trajectory_;
  double tick_s_;
  // Whole ticks are counted, so that their sum does not drift.
  double began_s_ = 0.0;
  int ticks_ = 0;
  PseudoDifferentiator filter_;
  std::optional<CommandShaping> shaping_;
  NominalMotion motion_;
};

}  // namespace nadir::control_client
