#include "control_client/path_trajectories.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nadir::control_client {
namespace {

class Corners : public Trajectory {
 public:
  Corners(const std::vector<Eigen::Vector2d>& corners_m, double speed_mps) : speed_mps_(speed_mps) {
    double heading_rad = 0.0;
    double begin_s = 0.0;
    for (std::size_t i = 0; i + 1 < corners_m.size(); ++i) {
      const Eigen::Vector2d way = corners_m[i + 1] - corners_m[i];
      const double turn_rad = std::atan2(way.y(), way.x()) - heading_rad;
      heading_rad += std::remainder(turn_rad, 2.0 * std::numbers::pi);
      sides_.push_back({begin_s, corners_m[i], way.normalized(), heading_rad});
      begin_s += way.norm() / speed_mps;
    }
    duration_s_ = begin_s;
  }
  double duration_s() const override { return duration_s_; }

 private:
  struct Side {
    double begin_s;
    Eigen::Vector2d from_m;
    Eigen::Vector2d direction;
    double heading_rad;
  };

  TrajectoryPoint within(double time_s) const override {
    const auto next = std::upper_bound(sides_.begin(), sides_.end(), time_s,
                                       [](double t, const Side& side) { return t < side.begin_s; });
    const Side& side = *std::prev(next);
    const Eigen::Vector2d velocity_mps = speed_mps_ * side.direction;
    const Eigen::Vector2d place_m = side.from_m + (time_s - side.begin_s) * velocity_mps;
    return {{place_m.x(), place_m.y(), side.heading_rad},
            {velocity_mps.x(), velocity_mps.y(), 0.0},
            Eigen::Vector3d::Zero()};
  }

  double speed_mps_;
  double duration_s_ = 0.0;
  std::vector<Side> sides_;
};

class TwoCircles : public Trajectory {
 public:
  TwoCircles(double radius_m, double speed_mps) : radius_m_(radius_m), speed_mps_(speed_mps) {}
  double duration_s() const override { return 2.0 * lap_s(); }

 private:
  double lap_s() const { return 2.0 * std::numbers::pi * radius_m_ / speed_mps_; }

  TrajectoryPoint within(double time_s) const override {
    const bool is_first = time_s < lap_s();
    const double side = is_first ? 1.0 : -1.0;  // the centre is to the left, then to the right
    const double rate = side * speed_mps_ / radius_m_;
    const double heading = rate * (is_first ? time_s : time_s - lap_s());
    const double unwound = is_first ? heading : heading + 2.0 * std::numbers::pi;
    const double c = std::cos(heading);
    const double s = std::sin(heading);
    return {{side * radius_m_ * s, side * radius_m_ * (1.0 - c), unwound},
            {speed_mps_ * c, speed_mps_ * s, rate},
            {-speed_mps_ * rate * s, speed_mps_ * rate * c, 0.0}};
  }

  double radius_m_;
  double speed_mps_;
};

}  // namespace

TrajectoryPtr corner_trajectory(const std::vector<Eigen::Vector2d>& corners_m, double speed_mps) {
  return std::make_shared<Corners>(corners_m, speed_mps);
}

TrajectoryPtr two_circles_trajectory(const Eigen::Vector3d& start, double radius_m,
                                     double speed_mps) {
  return placed(std::make_shared<TwoCircles>(radius_m, speed_mps), start);
}

TrajectoryPtr l_shapes_trajectory() {
  return corner_trajectory({{0.5, 0.5}, {2.0, 0.5}, {2.0, 2.0}, {3.5, 2.0}, {3.5, 3.5}}, 0.1);
}

TrajectoryPtr s1_circles_trajectory() { return two_circles_trajectory({0.5, 0.5, 0.0}, 0.5, 0.1); }

TrajectoryPtr square_along_trajectory() {
  return corner_trajectory({{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}}, 0.1);
}

}  // namespace nadir::control_client
