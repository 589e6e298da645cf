#include "control_client/drive/motion_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace nadir::control_client {
namespace {

// From pose to pose (x m, y m, unwrapped heading rad), by turns in place and a straight drive.
std::vector<Eigen::Vector3d> turning_way(const Eigen::Vector3d& start,
                                         const Eigen::Vector3d& goal) {
  constexpr double kThere_m = 0.02;  // nearer than that, the controller's own matter
  const Eigen::Vector2d way_m = (goal - start).head<2>();
  if (way_m.norm() < kThere_m) return {start, goal};
  const double turn_rad = fusion::wrap_angle(std::atan2(way_m.y(), way_m.x()) - start.z());
  const bool is_behind = std::abs(turn_rad) > 0.5 * std::numbers::pi;
  const double away_rad = is_behind ? fusion::wrap_angle(turn_rad + std::numbers::pi) : turn_rad;
  // The end is the trajectory's own heading, whatever its turns.
  const double along_rad = goal.z() + fusion::wrap_angle(start.z() + away_rad - goal.z());
  return {{start.x(), start.y(), along_rad - away_rad},
          {start.x(), start.y(), along_rad},
          {goal.x(), goal.y(), along_rad},
          goal};
}

}  // namespace

MotionPlan::MotionPlan(const RobotModel& model, const ControlParameters& control,
                       const PlanSettings& settings, TrajectoryPtr trajectory)
    : model_(&model), control_(control), settings_(settings), trajectory_(std::move(trajectory)) {
  motion_.pose = trajectory_->at(0.0).pose;
  command_ = motion_;
}

void MotionPlan::start_from(const fusion::PlanarPose& pose) {
  const Eigen::Vector3d goal = trajectory_->at(time_s_).pose;
  const Eigen::Vector3d start(pose.x_m, pose.y_m,
                              goal.z() + fusion::wrap_angle(pose.heading_rad - goal.z()));
  const std::vector<Eigen::Vector3d> way = settings_.moves_sideways
                                               ? std::vector<Eigen::Vector3d>{start, goal}
                                               : turning_way(start, goal);
  approach_ = waypoint_trajectory(way, settings_.approach);
  approach_time_s_ = 0.0;
  pace_ = 0.0;
  phase_ = Phase::kApproach;
  motion_ = {way.front(), Eigen::Vector3d::Zero()};
  command_ = motion_;
}

void MotionPlan::advance(double dt_s, double target_pace) {
  const double step = dt_s / settings_.ramp_s;
  pace_ = std::clamp(target_pace, pace_ - step, pace_ + step);
  if (phase_ == Phase::kApproach) {
    advance_approach(dt_s);
  } else if (phase_ == Phase::kFollow) {
    advance_follow(dt_s);
  } else if (phase_ == Phase::kOver) {
    // A filtered motion is still on its way.
    generator_->advance(dt_s, 0.0);
    motion_ = generator_->motion();
  }
}

void MotionPlan::advance_approach(double dt_s) {
  approach_time_s_ += pace_ * dt_s;
  const TrajectoryPoint point = approach_->at(approach_time_s_);
  command_ = {point.pose, pace_ * point.velocity_per_s};
  motion_ = command_;
  if (approach_time_s_ >= approach_->duration_s()) follow();
}

void MotionPlan::follow() {
  phase_ = Phase::kFollow;
  pace_ = 0.0;
  generator_.emplace(*model_, control_, settings_.nominal, rest_of(trajectory_, time_s_));
}

void MotionPlan::advance_follow(double dt_s) {
  // At most so fast that the pace can fall to nothing until the end, at its own rate:
  // pace^2 ramp / 2 = time that is left.
  const double left_s = trajectory_->duration_s() - time_s_;
  pace_ = std::min(pace_, std::sqrt(2.0 * left_s / settings_.ramp_s));
  const double step_s = std::min(pace_ * dt_s, left_s);
  const bool is_over = step_s >= left_s;
  time_s_ += step_s;
  generator_->advance(dt_s, step_s / dt_s);
  motion_ = generator_->motion();
  const TrajectoryPoint point = trajectory_->at(time_s_);
  command_ = {point.pose, pace_ * point.velocity_per_s};
  if (!is_over) return;
  ++rounds_;
  command_.velocity_per_s.setZero();
  phase_ = Phase::kOver;
  pace_ = 0.0;
  if (!settings_.repeats) return;
  time_s_ = 0.0;
  start_from({motion_.pose.x(), motion_.pose.y(), motion_.pose.z()});
}

}  // namespace nadir::control_client
