#include "control_client/trajectory_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "fusion/planar_pose.h"
#include "vision/input/csv_table.h"
#include "vision/input/strict_yaml.h"

namespace nadir::control_client {
namespace {

// Peaks of the quintic from 0 to 1 in unit time.
constexpr double kQuinticSpeed = 1.875;
constexpr double kQuinticAcceleration = 5.773502691896258;  // 10 / sqrt 3

double leg_duration_s(double distance, double speed, double acceleration) {
  return std::max(kQuinticSpeed * distance / speed,
                  std::sqrt(kQuinticAcceleration * distance / acceleration));
}

class Waypoints : public Trajectory {
 public:
  Waypoints(const std::vector<Eigen::Vector3d>& waypoints, const MotionLimits& limits) {
    double start_s = 0.0;
    for (std::size_t i = 0; i + 1 < waypoints.size(); ++i) {
      const Eigen::Vector3d way = waypoints[i + 1] - waypoints[i];
      const double length_s =
          std::max(leg_duration_s(way.head<2>().norm(), limits.speed_mps, limits.acceleration_mps2),
                   leg_duration_s(std::abs(way.z()), limits.turn_rate_radps,
                                  limits.turn_acceleration_radps2));
      if (length_s <= 0.0) continue;
      legs_.push_back({start_s, length_s, waypoints[i], way});
      start_s += length_s;
    }
    if (legs_.empty()) legs_.push_back({0.0, 1.0, waypoints.front(), Eigen::Vector3d::Zero()});
  }
  double duration_s() const override { return legs_.back().start_s + legs_.back().length_s; }

 private:
  struct Leg {
    double start_s;
    double length_s;
    Eigen::Vector3d from;
    Eigen::Vector3d way;
  };

  TrajectoryPoint within(double time_s) const override {
    const auto after = std::upper_bound(legs_.begin(), legs_.end(), time_s,
                                        [](double t, const Leg& leg) { return t < leg.start_s; });
    const Leg& leg = after == legs_.begin() ? legs_.front() : *std::prev(after);
    const double s = std::min((time_s - leg.start_s) / leg.length_s, 1.0);
    const double place = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
    const double speed = 30.0 * s * s * (1.0 - s) * (1.0 - s) / leg.length_s;
    const double acceleration =
        60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (leg.length_s * leg.length_s);
    return {leg.from + place * leg.way, speed * leg.way, acceleration * leg.way};
  }

  std::vector<Leg> legs_;
};

class Spline : public Trajectory {
 public:
  Spline(const std::vector<double>& times_s, const std::vector<Eigen::Vector3d>& poses)
      : times_s_(times_s), poses_(poses), rates_(poses.size(), Eigen::Vector3d::Zero()) {
    solve_rates();
  }
  double duration_s() const override { return times_s_.back(); }

 private:
  // Velocities at the knots that make the acceleration continuous, zero at both ends:
  //     m(i-1)/h(i-1) + 2 (1/h(i-1) + 1/h(i)) m(i) + m(i+1)/h(i)
  //         = 3 (p(i) - p(i-1))/h(i-1)^2 + 3 (p(i+1) - p(i))/h(i)^2,
  // solved by Thomas' algorithm.
  void solve_rates() {
    const std::size_t last = poses_.size() - 1;
    std::vector<double> upper(poses_.size(), 0.0);
    for (std::size_t i = 1; i < last; ++i) {
      const double before = 1.0 / (times_s_[i] - times_s_[i - 1]);
      const double behind = 1.0 / (times_s_[i + 1] - times_s_[i]);
      const double pivot = 2.0 * (before + behind) - before * upper[i - 1];
      upper[i] = behind / pivot;
      const Eigen::Vector3d right = 3.0 * before * before * (poses_[i] - poses_[i - 1]) +
                                    3.0 * behind * behind * (poses_[i + 1] - poses_[i]);
      rates_[i] = (right - before * rates_[i - 1]) / pivot;
    }
    for (std::size_t i = last; i-- > 1;) rates_[i] -= upper[i] * rates_[i + 1];
  }

  TrajectoryPoint within(double time_s) const override {
    const auto after = std::upper_bound(times_s_.begin(), times_s_.end(), time_s);
    const auto found = static_cast<std::size_t>(after - times_s_.begin());
    const std::size_t i = std::clamp<std::size_t>(found, 1, times_s_.size() - 1) - 1;
    const double h = times_s_[i + 1] - times_s_[i];
    const double s = (time_s - times_s_[i]) / h;
    const Eigen::Vector3d way = poses_[i + 1] - poses_[i];
    // Hermite form p = p0 + h m0 s + b s^2 + c s^3.
    const Eigen::Vector3d b = 3.0 * way - h * (2.0 * rates_[i] + rates_[i + 1]);
    const Eigen::Vector3d c = -2.0 * way + h * (rates_[i] + rates_[i + 1]);
    return {poses_[i] + s * (h * rates_[i] + s * (b + s * c)),
            rates_[i] + s * (2.0 * b + 3.0 * s * c) / h, (2.0 * b + 6.0 * s * c) / (h * h)};
  }

  std::vector<double> times_s_;
  std::vector<Eigen::Vector3d> poses_;
  std::vector<Eigen::Vector3d> rates_;
};

TrajectoryPtr load_csv(const std::filesystem::path& file) {
  const auto table = vision::CsvTable::load(file, {"t_s", "x_m", "y_m", "heading_rad"});
  if (table.rows() < 2) {
    throw vision::InputError({file.string(), 0, 0}, "a trajectory needs two rows at least",
                             "add rows t_s,x_m,y_m,heading_rad");
  }
  std::vector<double> times_s;
  std::vector<Eigen::Vector3d> poses;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double time_s = table.number(row, 0) - table.number(0, 0);
    if (row > 0 && time_s <= times_s.back()) {
      throw table.error(row, 0, "the time does not rise", "order the rows by t_s");
    }
    double heading_rad = table.number(row, 3);
    if (row > 0) {
      heading_rad = poses.back().z() + fusion::wrap_angle(heading_rad - poses.back().z());
    }
    times_s.push_back(time_s);
    poses.emplace_back(table.number(row, 1), table.number(row, 2), heading_rad);
  }
  return spline_trajectory(times_s, poses);
}

TrajectoryPtr load_yaml(const std::filesystem::path& file) {
  constexpr vision::ValidRange kPlace_m{-1000.0, 1000.0};
  constexpr vision::ValidRange kRate{1e-3, 100.0};
  const auto map = vision::YamlMap::load(file);
  std::vector<Eigen::Vector3d> waypoints;
  for (const vision::YamlMap& each : map.maps("waypoints")) {
    const double x_m = each.number("x_m", kPlace_m);
    const double y_m = each.number("y_m", kPlace_m);
    waypoints.emplace_back(x_m, y_m, each.number_or("heading_rad", 0.0, {-100.0, 100.0}));
    each.finish();
  }
  if (waypoints.size() < 2) {
    throw map.error("waypoints", "a trajectory needs two waypoints at least", "add some");
  }
  MotionLimits limits;
  limits.speed_mps = map.number_or("speed_mps", limits.speed_mps, kRate);
  limits.acceleration_mps2 = map.number_or("acceleration_mps2", limits.acceleration_mps2, kRate);
  limits.turn_rate_radps = map.number_or("turn_rate_radps", limits.turn_rate_radps, kRate);
  limits.turn_acceleration_radps2 =
      map.number_or("turn_acceleration_radps2", limits.turn_acceleration_radps2, kRate);
  map.finish();
  return waypoint_trajectory(waypoints, limits);
}

TrajectoryPtr find_trajectory(const std::string& name_or_file) {
  if (TrajectoryPtr trajectory = standard_trajectory(name_or_file)) return trajectory;
  if (!std::filesystem::path(name_or_file).extension().empty()) {
    return load_trajectory(name_or_file);
  }
  std::string names;
  for (const NamedTrajectory& each : standard_trajectories()) names += each.name + ", ";
  throw vision::InputError({"nadir-client", 0, 0}, "no trajectory is called '" + name_or_file + "'",
                           "choose one of " + names + "or a .csv or .yaml file");
}

}  // namespace

TrajectoryPtr waypoint_trajectory(const std::vector<Eigen::Vector3d>& waypoints,
                                  const MotionLimits& limits) {
  assert(waypoints.size() >= 2);
  return std::make_shared<Waypoints>(waypoints, limits);
}

TrajectoryPtr spline_trajectory(const std::vector<double>& times_s,
                                const std::vector<Eigen::Vector3d>& poses) {
  assert(times_s.size() == poses.size() && times_s.size() >= 2 && times_s.front() == 0.0);
  return std::make_shared<Spline>(times_s, poses);
}

TrajectoryPtr load_trajectory(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".csv") return load_csv(file);
  if (extension == ".yaml" || extension == ".yml") return load_yaml(file);
  throw vision::InputError({file.string(), 0, 0}, "a trajectory is a .csv or .yaml file",
                           "name one, or a trajectory of nadir-client list");
}

TrajectoryPtr choose_trajectory(const std::string& name_or_file, const RobotModel& model,
                                double speed) {
  TrajectoryPtr trajectory = find_trajectory(name_or_file);
  if (speed != 1.0) trajectory = time_scaled(trajectory, speed);
  const TrajectoryDemand demand = trajectory_demand(*trajectory, model);
  const double most = std::max(demand.speed, demand.voltage);
  if (most > 1.0) {
    throw vision::InputError(
        {name_or_file, 0, 0},
        fmt::format("the trajectory asks for {:.2f} times the robot's {}", most,
                    demand.speed >= demand.voltage ? "speed limit" : "motor voltage"),
        fmt::format("drive it at {:.2f} of this speed or slower", 0.99 / most));
  }
  return trajectory;
}

TrajectoryPtr fitting_trajectory(const std::string& name_or_file, const RobotModel& model,
                                 double speed) {
  const TrajectoryPtr path = find_trajectory(name_or_file);
  const auto fits = [&](double factor) {
    const TrajectoryDemand demand = trajectory_demand(*time_scaled(path, factor), model);
    return std::max(demand.speed, demand.voltage) <= 1.0;
  };
  if (fits(speed)) return time_scaled(path, speed);
  // Between a factor that fits and twice as much, which does not.
  constexpr int kHalvings = 20;
  double slow = 0.5 * speed;
  for (int i = 0; i < kHalvings && !fits(slow); ++i) slow *= 0.5;
  if (!fits(slow)) {
    throw vision::InputError({name_or_file, 0, 0}, "no speed of this trajectory suits the robot",
                             "see its limits");
  }
  double fast = 2.0 * slow;
  constexpr int kBisections = 7;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (slow + fast);
    (fits(middle) ? slow : fast) = middle;
  }
  return time_scaled(path, slow);
}

}  // namespace nadir::control_client
