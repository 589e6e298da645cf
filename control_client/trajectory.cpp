#include "control_client/trajectory.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "control_client/nominal_motion.h"
#include "control_client/path_trajectories.h"

namespace nadir::control_client {
namespace {

constexpr double kPi = std::numbers::pi;

class Square : public Trajectory {
 public:
  Square(double side_m, double speed_mps, int laps, double turn_per_side_rad)
      : side_m_(side_m),
        side_s_(side_m / speed_mps),
        sides_(4 * laps),
        turn_rad_(turn_per_side_rad) {}
  double duration_s() const override { return sides_ * side_s_; }

 private:
  TrajectoryPoint within(double time_s) const override {
    const int side = std::min(static_cast<int>(time_s / side_s_), sides_ - 1);
    const double share = time_s / side_s_ - side;
    constexpr double kCorners[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
    const auto& from = kCorners[side % 4];
    const auto& to = kCorners[(side + 1) % 4];
    const Eigen::Vector3d start(side_m_ * from[0], side_m_ * from[1], turn_rad_ * side);
    const Eigen::Vector3d way(side_m_ * (to[0] - from[0]), side_m_ * (to[1] - from[1]), turn_rad_);
    return {start + share * way, way / side_s_, Eigen::Vector3d::Zero()};
  }

  double side_m_;
  double side_s_;
  int sides_;
  double turn_rad_;
};

class Circle : public Trajectory {
 public:
  Circle(double radius_m, double turn_rate_radps, double ramp_s, double duration_s)
      : radius_m_(radius_m), rate_(turn_rate_radps), ramp_s_(ramp_s), duration_s_(duration_s) {}
  double duration_s() const override { return duration_s_; }

 private:
  TrajectoryPoint within(double time_s) const override {
    const bool ramps = time_s < ramp_s_;
    const double gain = ramps ? rate_ / ramp_s_ : 0.0;
    const double speed = ramps ? gain * time_s : rate_;
    const double angle = ramps ? 0.5 * gain * time_s * time_s : rate_ * (time_s - 0.5 * ramp_s_);
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    const Eigen::Vector3d along(-out.y(), out.x(), 0.0);
    return {radius_m_ * out, radius_m_ * speed * along,
            radius_m_ * (gain * along - speed * speed * out)};
  }

  double radius_m_;
  double rate_;
  double ramp_s_;
  double duration_s_;
};

// x + i y = a sin(n t) e^(i t) with the angle t.
class Rose : public Trajectory {
 public:
  Rose(double amplitude_m, int petals, double turn_rate_radps)
      : amplitude_m_(amplitude_m), petals_(petals), rate_(turn_rate_radps) {}
  double duration_s() const override { return 2.0 * kPi / rate_; }

 private:
  TrajectoryPoint within(double time_s) const override {
    const double angle = rate_ * time_s;
    const double radius = amplitude_m_ * std::sin(petals_ * angle);
    const double radius1 = amplitude_m_ * petals_ * rate_ * std::cos(petals_ * angle);
    const double radius2 = -petals_ * petals_ * rate_ * rate_ * radius;
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    const Eigen::Vector3d along(-out.y(), out.x(), 0.0);
    return {radius * out, radius1 * out + radius * rate_ * along,
            (radius2 - radius * rate_ * rate_) * out + 2.0 * radius1 * rate_ * along};
  }

  double amplitude_m_;
  int petals_;
  double rate_;
};

class Step : public Trajectory {
 public:
  Step(const Eigen::Vector3d& target, double duration_s)
      : target_(target), duration_s_(duration_s) {}
  double duration_s() const override { return duration_s_; }

 private:
  TrajectoryPoint within(double time_s) const override {
    TrajectoryPoint point;
    if (time_s > 0.0) point.pose = target_;
    return point;
  }

  Eigen::Vector3d target_;
  double duration_s_;
};

class TimeScaled : public Trajectory {
 public:
  TimeScaled(TrajectoryPtr trajectory, double factor)
      : trajectory_(std::move(trajectory)), factor_(factor) {}
  double duration_s() const override { return trajectory_->duration_s() / factor_; }

 private:
  TrajectoryPoint within(double time_s) const override {
    TrajectoryPoint point = trajectory_->at(factor_ * time_s);
    point.velocity_per_s *= factor_;
    point.acceleration_per_s2 *= factor_ * factor_;
    return point;
  }

  TrajectoryPtr trajectory_;
  double factor_;
};

class Placed : public Trajectory {
 public:
  Placed(TrajectoryPtr trajectory, const Eigen::Vector3d& place)
      : trajectory_(std::move(trajectory)),
        place_(place),
        rotation_(rotation_world_body(place.z())) {}
  double duration_s() const override { return trajectory_->duration_s(); }

 private:
  TrajectoryPoint within(double time_s) const override {
    const TrajectoryPoint point = trajectory_->at(time_s);
    return {place_ + rotation_ * point.pose, rotation_ * point.velocity_per_s,
            rotation_ * point.acceleration_per_s2};
  }

  TrajectoryPtr trajectory_;
  Eigen::Vector3d place_;
  Eigen::Matrix3d rotation_;
};

class RestOf : public Trajectory {
 public:
  RestOf(TrajectoryPtr trajectory, double time_s)
      : trajectory_(std::move(trajectory)), time_s_(time_s) {}
  double duration_s() const override { return std::max(0.0, trajectory_->duration_s() - time_s_); }

 private:
  TrajectoryPoint within(double time_s) const override { return trajectory_->at(time_s_ + time_s); }

  TrajectoryPtr trajectory_;
  double time_s_;
};

}  // namespace

TrajectoryPoint Trajectory::at(double time_s) const {
  const double end_s = duration_s();
  TrajectoryPoint point = within(std::clamp(time_s, 0.0, end_s));
  if (time_s < 0.0 || time_s > end_s) {
    point.velocity_per_s.setZero();
    point.acceleration_per_s2.setZero();
  }
  return point;
}

TrajectoryPtr square_trajectory(double side_m, double speed_mps, int laps,
                                double turn_per_side_rad) {
  return std::make_shared<Square>(side_m, speed_mps, laps, turn_per_side_rad);
}

TrajectoryPtr circle_trajectory(double radius_m, double turn_rate_radps, double ramp_s,
                                double duration_s) {
  return std::make_shared<Circle>(radius_m, turn_rate_radps, ramp_s, duration_s);
}

TrajectoryPtr rose_trajectory(double amplitude_m, int petals, double turn_rate_radps) {
  return std::make_shared<Rose>(amplitude_m, petals, turn_rate_radps);
}

TrajectoryPtr step_trajectory(const Eigen::Vector3d& target, double duration_s) {
  return std::make_shared<Step>(target, duration_s);
}

TrajectoryPtr time_scaled(TrajectoryPtr trajectory, double factor) {
  return std::make_shared<TimeScaled>(std::move(trajectory), factor);
}

TrajectoryPtr placed(TrajectoryPtr trajectory, const Eigen::Vector3d& place) {
  return std::make_shared<Placed>(std::move(trajectory), place);
}

TrajectoryPtr rest_of(TrajectoryPtr trajectory, double time_s) {
  return std::make_shared<RestOf>(std::move(trajectory), time_s);
}

const std::vector<NamedTrajectory>& standard_trajectories() {
  static const std::vector<NamedTrajectory> all = {
      {"square-turning", "square of 0.5 m at 0.2 m/s, two laps, an eighth turn a side",
       square_trajectory(0.5, 0.2, 2, kPi / 4.0)},
      {"square", "square of 0.5 m at 0.2 m/s, two laps, heading 0",
       square_trajectory(0.5, 0.2, 2, 0.0)},
      {"circle", "circle of 0.25 m radius at 1 rad/s, from rest, 20 s",
       circle_trajectory(0.25, 1.0, 2.0, 20.0)},
      {"rose3", "rose of three petals of 0.3 m, 31.4 s", rose_trajectory(0.3, 3, 0.2)},
      {"rose4", "rose of eight petals of 0.3 m, 31.4 s", rose_trajectory(0.3, 4, 0.2)},
      {"l-shapes", "two L shapes of 6 m at 0.1 m/s from (0.5, 0.5), heading along them",
       l_shapes_trajectory()},
      {"two-circles", "figure of eight of two circles of 0.5 m radius at 0.1 m/s, heading along it",
       s1_circles_trajectory()},
      {"square-along", "square of 1 m at 0.1 m/s, one lap, heading along it",
       square_along_trajectory()},
      {"step", "step of 1 m, 0.5 m and 1 rad, 8 s", step_trajectory({1.0, 0.5, 1.0}, 8.0)},
  };
  return all;
}

TrajectoryPtr standard_trajectory(const std::string& name) {
  for (const NamedTrajectory& known : standard_trajectories()) {
    if (known.name == name) return known.trajectory;
  }
  return nullptr;
}

TrajectoryDemand trajectory_demand(const Trajectory& trajectory, const RobotModel& model) {
  constexpr double kStep_s = 0.001;
  const RobotParameters& limits = model.parameters();
  TrajectoryDemand demand;
  for (double time_s = 0.0; time_s <= trajectory.duration_s(); time_s += kStep_s) {
    const TrajectoryPoint point = trajectory.at(time_s);
    const NominalMotion motion{point.pose, point.velocity_per_s};
    const Eigen::Vector3d rates = motion.body_rates();
    const Eigen::Vector3d acceleration =
        rotation_world_body(point.pose.z()).transpose() * point.acceleration_per_s2 +
        Eigen::Vector3d(rates.z() * rates.y(), -rates.z() * rates.x(), 0.0);
    demand.speed = std::max({demand.speed, rates.head<2>().norm() / limits.max_speed_mps,
                             std::abs(rates.z()) / limits.max_turn_rate_radps});
    demand.voltage =
        std::max(demand.voltage, model.voltages_v(rates, acceleration).cwiseAbs().maxCoeff() /
                                     limits.motor.max_voltage_v);
  }
  return demand;
}

}  // namespace nadir::control_client
