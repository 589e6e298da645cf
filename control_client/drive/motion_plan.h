#pragma once

#include <memory>
#include <optional>

#include "control_client/nominal_generator.h"
#include "control_client/nominal_motion.h"
#include "control_client/trajectory_file.h"
#include "fusion/planar_pose.h"

namespace nadir::control_client {

/// How a trajectory is driven.
struct PlanSettings {
  NominalSettings nominal{NominalKind::kExact, 0.0, {}};
  MotionLimits approach;  ///< of the way to the trajectory
  double ramp_s = 0.5;    ///< in which the pace goes from 0 to 1
  bool repeats = false;   ///< at its end the trajectory begins anew
  /// Whether the robot can move sideways. If not, it turns towards the trajectory (or its back,
  /// where that is less to turn), drives there, and turns along it.
  bool moves_sideways = true;
};

/// What the robot is meant to do, tick by tick: from wherever it stands to the trajectory, along
/// it, and to rest at its end. The trajectory's time runs at a pace between 0 and 1 that changes
/// gradually, so a robot that is slowed down or stopped loses no part of its path, and no velocity
/// jumps.
class MotionPlan {
 public:
  enum class Phase {
    kNone,      ///< nothing planned yet
    kApproach,  ///< on the way to the trajectory's present point
    kFollow,    ///< on the trajectory
    kOver,      ///< at rest at its end
  };

  /// `model` outlives the plan.
  MotionPlan(const RobotModel& model, const ControlParameters& control,
             const PlanSettings& settings, TrajectoryPtr trajectory);

  /// The robot stands here: leads to the point where the trajectory's time stands, at rest, and
  /// goes on from there.
  void start_from(const fusion::PlanarPose& pose);

  /// dt_s > 0 later; the pace goes towards `target_pace`, 0 to 1.
  void advance(double dt_s, double target_pace);

  /// Where to be now and how to move.
  const NominalMotion& motion() const { return motion_; }
  /// The same without command filter.
  const NominalMotion& command() const { return command_; }
  Phase phase() const { return phase_; }
  double pace() const { return pace_; }
  double trajectory_time_s() const { return time_s_; }
  /// Times that the trajectory was driven to its end.
  int rounds() const { return rounds_; }

 private:
  void follow();
  void advance_approach(double dt_s);
  void advance_follow(double dt_s);

  const RobotModel* model_;
  ControlParameters control_;
  PlanSettings settings_;
  TrajectoryPtr trajectory_;
  Phase phase_ = Phase::kNone;
  double pace_ = 0.0;
  double time_s_ = 0.0;  // of the trajectory
  int rounds_ = 0;
  TrajectoryPtr approach_;
  double approach_time_s_ = 0.0;
  std::optional<NominalGenerator> generator_;
  NominalMotion motion_;
  NominalMotion command_;
};

}  // namespace nadir::control_client
