#include "control_client/differential/corner_turns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "control_client/nominal_motion.h"
#include "vision/input/input_error.h"

namespace nadir::control_client {
namespace {

constexpr double kStep_s = 0.001;
constexpr double kJump_rad = 0.05;  // in a step: nobody turns at 50 rad/s

struct Corner {
  double time_s;       // on the trajectory
  TrajectoryPtr turn;  // in place
};

class CornerTurns : public Trajectory {
 public:
  CornerTurns(TrajectoryPtr trajectory, std::vector<Corner> corners)
      : trajectory_(std::move(trajectory)), corners_(std::move(corners)) {}

  double duration_s() const override {
    double sum_s = trajectory_->duration_s();
    for (const Corner& corner : corners_) sum_s += corner.turn->duration_s();
    return sum_s;
  }

 private:
  TrajectoryPoint within(double time_s) const override {
    for (const Corner& corner : corners_) {
      if (time_s < corner.time_s) break;
      const double turning_s = time_s - corner.time_s;
      if (turning_s < corner.turn->duration_s()) return corner.turn->at(turning_s);
      time_s -= corner.turn->duration_s();
    }
    return trajectory_->at(time_s);
  }

  TrajectoryPtr trajectory_;
  std::vector<Corner> corners_;
};

// The most forbidden moment of a trajectory.
struct SidewaysMotion {
  double speed_mps = 0.0;
  double time_s = 0.0;

  void see(const TrajectoryPoint& point, double now_s) {
    constexpr double kTolerance_mps = 0.01;
    constexpr double kTolerance = 0.1;  // share of the speed: splines are not quite along
    const Eigen::Vector3d rates = NominalMotion{point.pose, point.velocity_per_s}.body_rates();
    const double sideways_mps = std::abs(rates.y());
    if (sideways_mps <= std::max(kTolerance_mps, kTolerance * std::abs(rates.x()))) return;
    if (sideways_mps <= speed_mps) return;
    speed_mps = sideways_mps;
    time_s = now_s;
  }
};

void refuse(const std::string& name, const SidewaysMotion& sideways) {
  throw vision::InputError({name, 0, 0},
                           fmt::format("the trajectory moves sideways at {:.2f} m/s after {:.1f} "
                                       "s, which a differential robot cannot",
                                       sideways.speed_mps, sideways.time_s),
                           "let its heading follow its path, as two-circles does");
}

// The heading jumps between these times.
Corner corner_between(const Trajectory& trajectory, double before_s, double after_s,
                      const MotionLimits& limits) {
  const double heading_rad = trajectory.at(before_s).pose.z();
  constexpr int kHalvings = 30;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle_s = 0.5 * (before_s + after_s);
    const bool has_jumped =
        std::abs(trajectory.at(middle_s).pose.z() - heading_rad) > 0.5 * kJump_rad;
    (has_jumped ? after_s : before_s) = middle_s;
  }
  const Eigen::Vector3d to = trajectory.at(after_s).pose;
  const Eigen::Vector3d from(to.x(), to.y(), heading_rad);
  return {after_s, waypoint_trajectory({from, to}, limits)};
}

}  // namespace

TrajectoryPtr with_corner_turns(const std::string& name, TrajectoryPtr trajectory,
                                const MotionLimits& limits) {
  std::vector<Corner> corners;
  SidewaysMotion sideways;
  const int steps = static_cast<int>(std::floor(trajectory->duration_s() / kStep_s));
  TrajectoryPoint before = trajectory->at(0.0);
  for (int k = 0; k <= steps; ++k) {
    const double time_s = k * kStep_s;
    const TrajectoryPoint point = trajectory->at(time_s);
    sideways.see(point, time_s);
    if (std::abs(point.pose.z() - before.pose.z()) > kJump_rad) {
      corners.push_back(corner_between(*trajectory, time_s - kStep_s, time_s, limits));
    }
    before = point;
  }
  if (sideways.speed_mps > 0.0) refuse(name, sideways);
  if (corners.empty()) return trajectory;
  return std::make_shared<CornerTurns>(std::move(trajectory), std::move(corners));
}

}  // namespace nadir::control_client
