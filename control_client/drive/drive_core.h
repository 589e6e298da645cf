#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "control_client/control_loop.h"
#include "control_client/drive/frame_gaps.h"
#include "control_client/drive/motion_plan.h"
#include "control_client/drive/odometry_merger.h"
#include "control_client/drive/onboard_fusion.h"
#include "control_client/drive/safety.h"
#include "control_client/drive/steering.h"
#include "control_client/drive/tracker_clocks.h"
#include "tracker/wire/client_state.h"
#include "tracker/wire/clock_exchange.h"
#include "tracker/wire/emergency_stop.h"
#include "tracker/wire/robot_io.h"
#include "tracker/wire/wire_types.h"

namespace nadir::control_client {

/// Everything that the onboard process decides with.
struct DriveSettings {
  std::string team = "blue";
  std::int32_t robot = 0;
  std::uint64_t epoch = 1;  ///< this run of the client
  tracker::WheelCommandKind output = tracker::WheelCommandKind::kVolts;
  std::chrono::nanoseconds command_valid_for = std::chrono::milliseconds(100);
  ControlParameters control;
  PlanSettings plan;
  OnboardFusionSettings fusion;
  SafetySettings safety;
  std::optional<fusion::WheelGeometry> geometry;  ///< other wheels than the model's
  std::shared_ptr<Steering> steering;             ///< in place of the outer loop; null: none
};

/// What became of a pose from the network.
enum class PoseFate : std::uint8_t { kGiven, kNoClock };

/// The onboard process without threads, clocks and network: everything comes with its time from
/// outside, on the robot's clock, and the same events give the same commands.
///
///     estimate   odometry at once, poses when they come, capture times through the tracker's clock
///     decide     may the robot drive? (Safety)
///     follow     the plan's next motion, outer loop, inner loop
///
/// Robots whose firmware closes the inner loop get rim speeds or body rates.
class DriveCore {
 public:
  /// `model` outlives the core.
  DriveCore(const RobotModel& model, const DriveSettings& settings, TrajectoryPtr trajectory);

  void add_odometry(const OdometryInterval& odometry);
  PoseFate add_pose(const tracker::WirePose& pose);
  void add_clock(const tracker::ClockExchange& exchange);
  void apply(const tracker::WireEmergencyStop& stop) { stops_.apply(stop); }
  /// The client was asked to end: stand, whatever comes.
  void interrupt() { interrupted_ = true; }

  /// `periods` (1 or more) inner steps later, at `now`. Outer loop, plan and safety run at every
  /// tick that has begun since the last call, but at most once. The command holds until the next
  /// call.
  const tracker::WireWheelCommand& step(fusion::Timestamp now, std::int64_t periods);

  /// Whether the last step ran the outer loop.
  bool has_ticked() const { return has_ticked_; }
  /// As of the last tick.
  tracker::WireClientState state() const;
  const SafetyVerdict& verdict() const { return safety_.verdict(); }
  const MotionPlan& plan() const { return plan_; }
  const std::optional<fusion::Estimate>& estimate() const { return estimate_; }
  /// Where the encoders alone lead from the first estimate on; nothing before it.
  const std::optional<fusion::PlanarPose>& encoder_pose() const { return encoder_pose_; }
  const ControlLoop& loop() const { return loop_; }

 private:
  void give_odometry(const OdometryInterval& odometry);
  void tick(std::int64_t ticks);
  SafetyView view() const;
  void follow(double dt_s);
  bool motors_are_off() const;
  void fill_command();
  double largest_position_sigma_m() const;

  DriveSettings settings_;
  fusion::WheelGeometry geometry_;
  std::unique_ptr<OnboardFusion> fusion_;
  TrackerClocks clocks_;
  OdometryMerger merger_;
  FrameGaps gaps_;
  tracker::EmergencyStops stops_;
  Safety safety_;
  MotionPlan plan_;
  ControlLoop loop_;

  fusion::Timestamp now_{0};
  std::int64_t step_ = 0;  // inner steps since the start, slept ones included
  bool has_ticked_ = false;
  bool interrupted_ = false;
  bool clock_jumped_ = false;
  double command_gap_s_ = 0.0;
  double stands_for_s_ = 0.0;
  double saturated_share_ = 0.0;
  std::optional<fusion::Timestamp> last_odometry_;  // arrival, in steps' time
  bool has_new_odometry_ = false;
  Eigen::Vector3d measured_rates_ = Eigen::Vector3d::Zero();
  double measured_for_s_ = 0.0;  // since the last step
  std::optional<fusion::Estimate> estimate_;
  std::optional<fusion::PlanarPose> encoder_pose_;
  tracker::WireWheelCommand command_;
  tracker::WireClientCounts counts_;
};

}  // namespace nadir::control_client
