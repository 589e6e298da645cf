#include "control_client/drive/drive_core.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fusion/odometry.h"

namespace nadir::control_client {

using fusion::Timestamp;
using tracker::WheelCommandKind;

namespace {

/// FNV-1a: the filter tells cameras apart by number.
std::uint32_t number_of(const std::string& name) {
  std::uint32_t hash = 2166136261U;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  return hash;
}

std::uint32_t folded(std::uint64_t epoch) {
  return static_cast<std::uint32_t>(epoch ^ (epoch >> 32U));
}

}  // namespace

DriveCore::DriveCore(const RobotModel& model, const DriveSettings& settings,
                     TrajectoryPtr trajectory)
    : settings_(settings),
      geometry_(settings.geometry.value_or(model.geometry())),
      fusion_(make_onboard_fusion(geometry_, settings.fusion)),
      safety_(settings.safety),
      plan_(model, settings.control, settings.plan, std::move(trajectory)),
      loop_(model, settings.control) {
  command_.team = settings.team;
  command_.robot = settings.robot;
  command_.epoch = settings.epoch;
  command_.valid_for_ns = settings.command_valid_for.count();
}

void DriveCore::add_odometry(const OdometryInterval& odometry) {
  ++counts_.odometry_samples;
  has_new_odometry_ = true;
  const double length_s = fusion::to_seconds(odometry.to - odometry.from);
  if (length_s > 0.0) {
    const double sum_s = measured_for_s_ + length_s;
    measured_rates_ =
        (measured_for_s_ * measured_rates_ + length_s * odometry.mean_rates.vector()) / sum_s;
    measured_for_s_ = sum_s;
    if (encoder_pose_) {
      encoder_pose_ = fusion::moved(*encoder_pose_, odometry.mean_rates, length_s);
    }
  }
  if (const auto before = merger_.add(odometry)) give_odometry(*before);
}

void DriveCore::give_odometry(const OdometryInterval& odometry) {
  if (fusion_->add_odometry(odometry) == fusion::OdometryVerdict::kClockRestarted) {
    clock_jumped_ = true;
  }
}

PoseFate DriveCore::add_pose(const tracker::WirePose& pose) {
  const std::uint32_t camera = number_of(pose.camera);
  gaps_.add(camera, pose.epoch, pose.frame);
  const auto capture = clocks_.robot_time(pose.epoch, pose.capture_ns);
  if (!capture) return PoseFate::kNoClock;
  // A tick's odometry stays one interval, as pieces of it tell little of accelerations: a pose that
  // is newer than what was given waits for the tick. Only after missed ticks can it not.
  if (*capture > fusion_->latest_capture()) {
    if (const auto joined = merger_.take()) give_odometry(*joined);
  }
  fusion_->add_pose({.camera = camera,
                     .epoch = folded(pose.epoch),
                     .frame = pose.frame,
                     .capture = *capture,
                     .pose = pose.robot.pose_world_robot,
                     .covariance = pose.robot.covariance});
  return PoseFate::kGiven;
}

void DriveCore::add_clock(const tracker::ClockExchange& exchange) {
  if (clocks_.add(exchange)) clock_jumped_ = true;
}

const tracker::WireWheelCommand& DriveCore::step(Timestamp now, std::int64_t periods) {
  const std::int64_t inner_steps = settings_.control.inner_steps;
  const std::int64_t before = step_;
  step_ += periods;
  // The first call is a tick, and then every inner_steps-th.
  const std::int64_t ticks =
      before == 0 ? 1 : (step_ - 1) / inner_steps - (before - 1) / inner_steps;
  command_gap_s_ =
      std::max(command_gap_s_, now_ == Timestamp(0) ? 0.0 : fusion::to_seconds(now - now_));
  now_ = now;
  if (std::exchange(has_new_odometry_, false)) last_odometry_ = now;
  has_ticked_ = ticks > 0;
  if (has_ticked_) tick(ticks);
  const double dt_s = static_cast<double>(periods) * settings_.control.inner_step_s();
  command_.wheels = {};
  command_.wheels.count = static_cast<std::size_t>(geometry_.wheels());
  if (motors_are_off()) {
    loop_.restart_inner();
  } else if (settings_.output == WheelCommandKind::kVolts) {
    const WheelVector volts = loop_.inner_step(measured_rates_, dt_s);
    for (int i = 0; i < volts.size(); ++i)
      command_.wheels.values.at(static_cast<std::size_t>(i)) = volts(i);
  }
  measured_for_s_ = 0.0;
  fill_command();
  return command_;
}

// Motors without voltage brake by themselves: where nothing can be measured, where somebody wants
// it so, and once the robot stands, as the noise of its encoders would make it creep.
bool DriveCore::motors_are_off() const {
  constexpr double kBraking_s = 0.5;
  return verdict().reason == tracker::ClientReason::kNoOdometry ||
         verdict().mode == tracker::ClientMode::kEmergency ||
         verdict().mode == tracker::ClientMode::kStarting || stands_for_s_ > kBraking_s;
}

void DriveCore::fill_command() {
  const Eigen::Vector3d& rates = loop_.command();
  command_.stamp_ns = now_.count();
  ++command_.sequence;
  command_.kind = settings_.output;
  command_.body_rates = {rates.x(), rates.y(), rates.z()};
  if (settings_.output == WheelCommandKind::kRimSpeeds) {
    const WheelVector rims = geometry_.rim_speeds_mps(fusion::BodyRates::from(rates));
    for (int i = 0; i < rims.size(); ++i)
      command_.wheels.values.at(static_cast<std::size_t>(i)) = rims(i);
  }
}

void DriveCore::tick(std::int64_t ticks) {
  const double dt_s = static_cast<double>(ticks) * settings_.control.tick_s;
  ++counts_.ticks;
  counts_.ticks_missed += static_cast<std::uint64_t>(ticks - 1);
  if (const auto joined = merger_.take()) give_odometry(*joined);
  estimate_ = fusion_->estimate_at(now_);
  if (estimate_ && !encoder_pose_) encoder_pose_ = estimate_->pose;
  const double keep = std::exp(-dt_s);
  saturated_share_ = keep * saturated_share_ + (1.0 - keep) * (loop_.is_saturated() ? 1.0 : 0.0);

  const bool stood = !verdict().drives() || plan_.phase() == MotionPlan::Phase::kNone;
  const SafetyVerdict& now = safety_.update(view(), dt_s);
  command_gap_s_ = 0.0;
  clock_jumped_ = false;
  if (!now.drives() || !estimate_) {
    saturated_share_ = 0.0;
    stands_for_s_ += dt_s;
    loop_.tick_at(Eigen::Vector3d::Zero());
    return;
  }
  stands_for_s_ = 0.0;
  if (stood) {
    loop_.restart_outer();
    plan_.start_from(estimate_->pose);
  }
  follow(dt_s);
}

void DriveCore::follow(double dt_s) {
  plan_.advance(dt_s, verdict().pace);
  if (settings_.steering) {
    loop_.tick_at(settings_.steering->body_rates(estimate_->pose, plan_.motion(), dt_s));
  } else {
    loop_.tick(estimate_->pose, plan_.motion(), dt_s);
  }
}

SafetyView DriveCore::view() const {
  SafetyView view;
  view.emergency_stop = stops_.engaged(settings_.team, settings_.robot) != nullptr;
  view.interrupted = interrupted_;
  view.clock_known = clocks_.reading(now_).has_value();
  view.clock_jumped = clock_jumped_;
  view.command_gap_s = command_gap_s_;
  view.saturated_share = saturated_share_;
  view.trajectory_over = plan_.phase() == MotionPlan::Phase::kOver;
  if (last_odometry_) view.odometry_age_s = fusion::to_seconds(now_ - *last_odometry_);
  if (const auto capture = fusion_->last_used_capture()) {
    view.pose_age_s = fusion::to_seconds(now_ - *capture);
  }
  if (!estimate_) return view;
  view.position_sigma_m = largest_position_sigma_m();
  view.heading_sigma_rad = std::sqrt(estimate_->covariance(2, 2));
  if (verdict().drives() && plan_.phase() != MotionPlan::Phase::kNone) {
    const Eigen::Vector3d& nominal = plan_.motion().pose;
    const Eigen::Vector3d error = fusion::pose_difference(
        estimate_->pose, {nominal.x(), nominal.y(), fusion::wrap_angle(nominal.z())});
    view.off_track_m = error.head<2>().norm();
    view.off_track_rad = std::abs(error.z());
  }
  return view;
}

double DriveCore::largest_position_sigma_m() const {
  const Eigen::Matrix2d covariance = estimate_->covariance.topLeftCorner<2, 2>();
  const double mean = 0.5 * covariance.trace();
  const double half = 0.5 * (covariance(0, 0) - covariance(1, 1));
  return std::sqrt(std::max(0.0, mean + std::hypot(half, covariance(0, 1))));
}

tracker::WireClientState DriveCore::state() const {
  using fusion::PoseVerdict;
  tracker::WireClientState state;
  state.team = settings_.team;
  state.robot = settings_.robot;
  state.epoch = settings_.epoch;
  state.sequence = counts_.ticks;
  state.stamp_ns = now_.count();
  state.mode = verdict().mode;
  state.reason = verdict().reason;
  if (state.reason == tracker::ClientReason::kOther) state.text = "commands came too late";
  const Eigen::Vector3d& nominal = plan_.motion().pose;
  state.nominal_world_robot = {nominal.x(), nominal.y(), fusion::wrap_angle(nominal.z())};
  if (estimate_) {
    state.estimate_world_robot = estimate_->pose;
    state.covariance = estimate_->covariance;
    const Eigen::Vector3d error =
        rotation_world_body(nominal.z()).transpose() *
        fusion::pose_difference(estimate_->pose, state.nominal_world_robot);
    state.error_ahead_m = error.x();
    state.error_left_m = error.y();
    state.error_heading_rad = fusion::wrap_angle(error.z());
  }
  if (const auto capture = fusion_->last_used_capture()) {
    state.pose_age_ns = std::max<std::int64_t>(0, (now_ - *capture).count());
  }
  if (const auto clock = clocks_.reading(now_)) {
    state.clock_offset_ns = clock->offset.count();
    state.clock_sigma_ns = fusion::from_seconds(clock->sigma_s).count();
  }
  const fusion::FusionHealth health = fusion_->health();
  state.counts = counts_;
  state.counts.poses_accepted =
      health.count(PoseVerdict::kStarted) + health.count(PoseVerdict::kAccepted);
  state.counts.recoveries =
      health.count(PoseVerdict::kRecovered) + health.count(PoseVerdict::kReset);
  state.counts.poses_rejected = health.count(PoseVerdict::kGated);
  state.counts.poses_late = health.count(PoseVerdict::kTooOld);
  state.counts.poses_lost = gaps_.lost();
  return state;
}

}  // namespace nadir::control_client
