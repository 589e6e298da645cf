#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "control_client/drive/drive_core.h"
#include "control_client/drive/simulated_base.h"
#include "control_client/simulation/random_stream.h"

namespace nadir::control_client {

/// The tracker of a rehearsal: what it sees and how its poses come.
struct RehearsedVision {
  int steps_per_frame = 4;  ///< of 5 ms: 50 Hz
  double position_sigma_m = 0.0002;
  double heading_sigma_rad = 0.002;
  double min_delay_s = 0.06;
  double max_delay_s = 0.10;
  double loss = 0.1;
  std::int64_t clock_ahead_ns = 3'700'000'000;  ///< of the robot's clock
};

/// One row of what happened, at the end of a tick.
struct RehearsalRow {
  double time_s = 0.0;
  SafetyVerdict verdict;
  MotionPlan::Phase phase = MotionPlan::Phase::kNone;
  double trajectory_s = 0.0;
  NominalMotion nominal;
  fusion::PlanarPose truth;
  std::optional<fusion::Estimate> estimate;
};

/// DriveCore with simulated robot (omni3, its inner loop as on board), tracker and network in
/// simulated time: no thread, no clock, no DDS; the same on every machine. Members may be changed
/// between calls of run.
class Rehearsal {
 public:
  Rehearsal(const DriveSettings& settings, TrajectoryPtr trajectory, std::uint64_t seed,
            const std::optional<Eigen::Vector3d>& start = {});

  /// Goes on for so long; returns the rows of this time.
  std::vector<RehearsalRow> run(double duration_s);

  fusion::Timestamp now() const { return now_; }
  DriveCore& core() { return core_; }
  SimulatedBase& base() { return base_; }

  RehearsedVision vision;
  bool tracker_is_up = true;
  bool odometry_is_up = true;
  std::uint64_t tracker_epoch = 77;
  std::int64_t tracker_clock_jump_ns = 0;
  /// So many inner steps the process is not woken, once.
  int sleep_steps = 0;

 private:
  struct OnTheWay {
    fusion::Timestamp arrival;
    tracker::WirePose pose;
  };

  void capture();
  void deliver();
  void exchange_clocks();
  std::int64_t tracker_ns(fusion::Timestamp robot_time) const {
    return robot_time.count() + vision.clock_ahead_ns + tracker_clock_jump_ns;
  }

  RobotModel model_{RobotParameters{}};
  DriveSettings settings_;
  fusion::Timestamp now_{std::chrono::seconds(1000)};
  DriveCore core_;
  SimulatedBase base_;
  RandomStream random_;
  std::int64_t step_ = 0;
  std::int64_t slept_ = 0;
  std::uint64_t frame_ = 0;
  std::vector<OnTheWay> on_the_way_;
  std::vector<OdometryInterval> odometry_;
};

}  // namespace nadir::control_client
