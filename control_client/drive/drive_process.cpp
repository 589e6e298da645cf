#include "control_client/drive/drive_process.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "control_client/drive/dds_base.h"

namespace nadir::control_client {

using fusion::Timestamp;

namespace {

constexpr std::chrono::nanoseconds kNoWait{0};

DriveSettings settings_of(const DriveConfig& config, const DriveTask& task, std::uint64_t epoch) {
  DriveSettings settings;
  settings.team = config.team;
  settings.robot = task.robot;
  settings.epoch = epoch;
  settings.output = config.output;
  settings.command_valid_for = fusion::from_seconds(config.command_valid_s);
  settings.control = task.body.config.control;
  // Robots whose firmware closes the inner loop need a command at each tick only.
  if (config.output != tracker::WheelCommandKind::kVolts) settings.control.inner_steps = 1;
  settings.plan = config.plan;
  settings.fusion = config.fusion;
  settings.safety = config.safety;
  settings.geometry = task.body.geometry;
  settings.steering = task.body.steering;
  settings.plan.moves_sideways = task.body.moves_sideways;
  constexpr double kReserve = 0.9;  // the rest is the controller's
  const RobotParameters& robot = task.body.config.robot;
  MotionLimits& approach = settings.plan.approach;
  approach.speed_mps = std::min(approach.speed_mps, kReserve * robot.max_speed_mps);
  approach.turn_rate_radps =
      std::min(approach.turn_rate_radps, kReserve * robot.max_turn_rate_radps);
  return settings;
}

Timestamp period_of(const DriveConfig& config, const DriveTask& task) {
  const ControlParameters& control = task.body.config.control;
  const bool has_inner = config.output == tracker::WheelCommandKind::kVolts;
  return fusion::from_seconds(has_inner ? control.inner_step_s() : control.tick_s);
}

tracker::WireOptions place_of(const DriveConfig& config) {
  return {static_cast<std::uint32_t>(config.domain), config.partition};
}

}  // namespace

DriveProcess::DriveProcess(const DriveConfig& config, const DriveTask& task, Console console)
    : config_(config),
      task_(task),
      console_(std::move(console)),
      model_(task.body.config.robot),
      clock_(config.clock_error),
      epoch_(static_cast<std::uint64_t>(tracker::system_clock_ns())),
      participant_(place_of(config)),
      poses_(participant_, {.wire = place_of(config),
                            .filter = {.robot = task.robot, .team = config.team, .camera = ""}}),
      stops_(participant_, {.robot = task.robot, .team = config.team}),
      asker_(participant_, epoch_, [this] { return clock_.now().count(); }),
      states_(participant_),
      core_(model_, settings_of(config, task, epoch_), task.trajectory),
      scheduler_(ClientClock::steady_now(), period_of(config, task)),
      base_(make_base(config)),
      announcer_(fmt::format("{} {}", config.team, task.robot)),
      started_(clock_.at(scheduler_.next())),
      now_(started_) {
  if (!task_.log.empty()) log_.emplace(task_.log, base_->truth_at(started_).has_value());
}

std::unique_ptr<RobotBase> DriveProcess::make_base(const DriveConfig& config) {
  if (!task_.simulates) {
    return std::make_unique<DdsBase>(participant_, config.team, task_.robot,
                                     task_.body.geometry.value_or(model_.geometry()));
  }
  truths_.emplace(participant_);
  SimulationSettings simulation = config.simulation;
  simulation.start = config.start.value_or(task_.trajectory->at(0.0).pose);
  // A step earlier than the first period: that finds a first report.
  const Timestamp start = clock_.at(scheduler_.next()) - fusion::from_seconds(simulation.step_s);
  return task_.body.simulated(simulation, start,
                              [this](const TruthSample& truth) { publish(truth); });
}

void DriveProcess::publish(const TruthSample& truth) {
  truths_->write({.team = config_.team,
                  .robot = task_.robot,
                  .epoch = epoch_,
                  .time_ns = clock_.true_wall(truth.time).count(),
                  .pose_world_robot = truth.pose,
                  .velocity_x_mps = truth.velocity_per_s.x(),
                  .velocity_y_mps = truth.velocity_per_s.y(),
                  .heading_rate_radps = truth.velocity_per_s.z()});
}

void DriveProcess::run(const std::atomic<bool>& stop) {
  while (!stop.load() && !is_over()) {
    std::this_thread::sleep_until(std::chrono::steady_clock::time_point(scheduler_.next()));
    const std::int64_t periods = scheduler_.arrive(ClientClock::steady_now());
    if (periods > 0) step(periods);
  }
  finish();
}

void DriveProcess::step(std::int64_t periods) {
  inner_missed_ += static_cast<std::uint64_t>(periods - 1);
  now_ = clock_.now();
  base_->take_odometry(now_, &odometry_);
  for (const OdometryInterval& each : odometry_) core_.add_odometry(each);
  receive(now_);
  const tracker::WireWheelCommand& command = core_.step(now_, periods);
  base_->command(command, now_);
  if (core_.has_ticked()) report(now_);
  ask_clock(now_);
}

void DriveProcess::receive(Timestamp now) {
  tracker::ClockExchange exchange;
  while (asker_.poll(&exchange, kNoWait)) core_.add_clock(exchange);
  while (poses_.poll(&pose_, kNoWait)) {
    // A tracker that was not heard of before is asked at once.
    if (core_.add_pose(pose_) == PoseFate::kNoClock) next_question_ = std::min(next_question_, now);
  }
  tracker::WireEmergencyStop stop;
  while (stops_.poll(&stop, kNoWait)) core_.apply(stop);
}

void DriveProcess::ask_clock(Timestamp now) {
  if (now < next_question_) return;
  asker_.ask();
  next_question_ = now + fusion::from_seconds(config_.clock_ask_interval_s);
}

void DriveProcess::report(Timestamp now) {
  if (log_) log_->write(now, core_, base_->truth_at(now));
  const bool is_news = core_.verdict().mode != told_mode_;
  if (is_news || now >= next_state_) {
    told_mode_ = core_.verdict().mode;
    next_state_ = now + fusion::from_seconds(config_.state_interval_s);
    states_.write(core_.state());
  }
  if (const auto line = announcer_.line(core_.verdict(), now)) console_(*line);
}

bool DriveProcess::is_over() const {
  const double ran_s = fusion::to_seconds(now_ - started_);
  if (task_.duration_s) return ran_s >= *task_.duration_s;
  return core_.verdict().mode == tracker::ClientMode::kFinished;
}

void DriveProcess::finish() {
  core_.interrupt();
  constexpr int kTicksToStand = 10;
  for (int ticks = 0; ticks < kTicksToStand;) {
    std::this_thread::sleep_until(std::chrono::steady_clock::time_point(scheduler_.next()));
    const std::int64_t periods = scheduler_.arrive(ClientClock::steady_now());
    if (periods == 0) continue;
    step(periods);
    if (core_.has_ticked()) ++ticks;
  }
  states_.write(core_.state());
  if (log_) log_->finish();
  console_(summary());
}

std::string DriveProcess::summary() const {
  const tracker::WireClientState state = core_.state();
  const tracker::WireClientCounts& counts = state.counts;
  return fmt::format(
      "{} {}: {} ticks, {} missed; {} inner steps missed; poses: {} used, {} rejected, {} too "
      "late, {} lost on the way, {} recoveries; clock offset {:.6f} s",
      config_.team, task_.robot, counts.ticks, counts.ticks_missed, inner_missed_,
      counts.poses_accepted, counts.poses_rejected, counts.poses_late, counts.poses_lost,
      counts.recoveries, 1e-9 * static_cast<double>(state.clock_offset_ns));
}

}  // namespace nadir::control_client
