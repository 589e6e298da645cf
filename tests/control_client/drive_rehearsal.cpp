#include "tests/control_client/drive_rehearsal.h"

#include <algorithm>
#include <cmath>

#include "control_client/slip_tolerance.h"

namespace nadir::control_client {

using fusion::Timestamp;

namespace {

constexpr Timestamp kStep = std::chrono::milliseconds(5);

DriveSettings on_board(DriveSettings settings, const RobotModel& model) {
  settings.control = tolerating_slip(model, settings.control);
  return settings;
}

SimulationSettings simulation(const Eigen::Vector3d& start, std::uint64_t seed) {
  SimulationSettings settings;
  settings.start = start;
  settings.seed = seed;
  return settings;
}

}  // namespace

Rehearsal::Rehearsal(const DriveSettings& settings, TrajectoryPtr trajectory, std::uint64_t seed,
                     const std::optional<Eigen::Vector3d>& start)
    : settings_(on_board(settings, model_)),
      core_(model_, settings_, trajectory),
      base_(model_, settings_.control.inner,
            simulation(start.value_or(trajectory->at(0.0).pose), seed), now_, {}),
      random_(seed, RandomPurpose::kVision) {}

std::vector<RehearsalRow> Rehearsal::run(double duration_s) {
  std::vector<RehearsalRow> rows;
  const auto steps = static_cast<std::int64_t>(std::lround(duration_s / 0.005));
  for (std::int64_t i = 0; i < steps; ++i) {
    now_ += kStep;
    ++step_;
    if (tracker_is_up && step_ % vision.steps_per_frame == 0) capture();
    if (tracker_is_up && step_ % 40 == 1) exchange_clocks();
    ++slept_;
    if (sleep_steps > 0) {
      --sleep_steps;
      continue;
    }
    base_.take_odometry(now_, &odometry_);
    for (const OdometryInterval& each : odometry_) {
      if (odometry_is_up) core_.add_odometry(each);
    }
    deliver();
    base_.command(core_.step(now_, slept_), now_);
    slept_ = 0;
    if (!core_.has_ticked()) continue;
    rows.push_back({1e-9 * static_cast<double>(now_.count()) - 1000.0, core_.verdict(),
                    core_.plan().phase(), core_.plan().trajectory_time_s(), core_.plan().motion(),
                    *base_.truth_at(now_), core_.estimate()});
  }
  return rows;
}

void Rehearsal::capture() {
  const double delay_s = random_.uniform(vision.min_delay_s, vision.max_delay_s);
  tracker::WirePose pose;
  pose.camera = "cam0";
  pose.epoch = tracker_epoch;
  pose.frame = frame_++;
  pose.capture_ns = tracker_ns(now_);
  pose.robot.team = settings_.team;
  pose.robot.robot = settings_.robot;
  // The plant stands at the end of its last step; the robot may sleep.
  const fusion::PlanarPose truth = *base_.truth_at(now_);
  pose.robot.pose_world_robot = {
      truth.x_m + vision.position_sigma_m * random_.normal(),
      truth.y_m + vision.position_sigma_m * random_.normal(),
      fusion::wrap_angle(truth.heading_rad + vision.heading_sigma_rad * random_.normal())};
  pose.robot.covariance =
      Eigen::Vector3d(vision.position_sigma_m, vision.position_sigma_m, vision.heading_sigma_rad)
          .cwiseAbs2()
          .asDiagonal();
  if (random_.uniform() < vision.loss) return;
  on_the_way_.push_back({now_ + fusion::from_seconds(delay_s), pose});
}

void Rehearsal::deliver() {
  for (const OnTheWay& each : on_the_way_) {
    if (each.arrival <= now_) core_.add_pose(each.pose);
  }
  std::erase_if(on_the_way_, [&](const OnTheWay& each) { return each.arrival <= now_; });
}

void Rehearsal::exchange_clocks() {
  constexpr Timestamp kWay = std::chrono::microseconds(150);
  core_.add_clock({.epoch = tracker_epoch,
                   .sequence = static_cast<std::uint64_t>(step_),
                   .t1_ns = (now_ - 2 * kWay).count(),
                   .t2_ns = tracker_ns(now_ - kWay),
                   .t3_ns = tracker_ns(now_ - kWay),
                   .t4_ns = now_.count()});
}

}  // namespace nadir::control_client
