#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "control_client/control_loop.h"
#include "control_client/control_parameters.h"
#include "control_client/experiment/estimator.h"
#include "control_client/experiment/race.h"
#include "control_client/simulation/encoders.h"
#include "control_client/simulation/faults.h"
#include "control_client/simulation/vision_feed.h"

namespace nadir::control_client {

/// One run of the closed loop in simulated time: everything but the estimators.
struct Scenario {
  TrajectoryPtr trajectory;
  double duration_s = 0.0;  ///< 0: the trajectory's own
  /// Leads the robot from the trajectory's start on instead of the trajectory. The nominal motion
  /// is then where the robot believes to be, and the command the corner that it is on its way to.
  std::optional<RaceParameters> race;
  RobotParameters robot;
  ControlParameters control;
  NominalSettings nominal;
  EncoderParameters encoders;
  VisionParameters vision;
  Faults faults;
  std::uint64_t run_seed = 1000;
  /// The run counts as diverged if the robot was ever farther from the nominal motion.
  double diverged_m = 0.5;
  double diverged_rad = 1.5707963267948966;
};

/// The end of one tick. Poses are x m, y m, heading rad; headings of command, nominal and truth are
/// unwrapped.
struct TickRecord {
  double time_s = 0.0;
  Eigen::Vector3d command = Eigen::Vector3d::Zero();  ///< the trajectory itself, without preview
  NominalMotion nominal;
  Eigen::Vector3d truth = Eigen::Vector3d::Zero();
  Eigen::Vector3d true_mean_rates = Eigen::Vector3d::Zero();  ///< over the tick: u, v, r
  fusion::BodyRates measured_mean_rates;
  bool is_saturated = false;        ///< a motor was at its limit
  double demanded_voltage_v = 0.0;  ///< largest of the inner loop, before the limit
};

struct EstimateRecord {
  fusion::PlanarPose pose;
  std::optional<fusion::PoseCovariance> covariance;
};

/// All that happened in a run. Estimates and decisions: an element for each estimator, the one that
/// drove first.
struct RunRecord {
  double tick_s = 0.0;
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  std::vector<TickRecord> ticks;
  std::vector<std::vector<EstimateRecord>> estimates;
  std::vector<std::vector<FrameDecision>> decisions;
  std::vector<VisionFrame> frames;  ///< in order of capture, the lost ones too
  bool has_diverged = false;
};

/// Time stamp of a tick, as estimators get it.
fusion::Timestamp tick_time(int tick, double tick_s);

/// Runs the loop. The first estimator drives, the others watch. The order within a tick: inner loop
/// and plant, encoders, odometry, capture, arriving frames, outer loop.
RunRecord run_scenario(const Scenario& scenario, std::span<Estimator* const> estimators);
RunRecord run_scenario(const Scenario& scenario, Estimator& driver);

}  // namespace nadir::control_client
