#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "control_client/robot_model.h"

namespace nadir::control_client {

/// Where to be at one instant and how to move there, in the world frame, order x, y, heading;
/// m and rad, by s and s^2. The heading is unwrapped: it never jumps.
struct TrajectoryPoint {
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_per_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_per_s2 = Eigen::Vector3d::Zero();
};

/// A motion over [0, duration]. Before it the robot is at rest at the start, after it at the end.
class Trajectory {
 public:
  virtual ~Trajectory() = default;
  TrajectoryPoint at(double time_s) const;
  virtual double duration_s() const = 0;

 protected:
  Trajectory() = default;
  Trajectory(const Trajectory&) = default;
  Trajectory& operator=(const Trajectory&) = default;

 private:
  /// time_s lies in [0, duration].
  virtual TrajectoryPoint within(double time_s) const = 0;
};

using TrajectoryPtr = std::shared_ptr<const Trajectory>;

/// The trajectories of S0's experiments and the step of command shaping, with their names.
struct NamedTrajectory {
  std::string name;
  std::string description;  ///< one line
  TrajectoryPtr trajectory;
};
const std::vector<NamedTrajectory>& standard_trajectories();
/// Null if no standard trajectory has this name.
TrajectoryPtr standard_trajectory(const std::string& name);

/// Square around the origin from its lower left corner, counter-clockwise, at constant speed; the
/// velocity jumps in the corners.
TrajectoryPtr square_trajectory(double side_m, double speed_mps, int laps,
                                double turn_per_side_rad);
/// Circle around the origin from its rightmost point, counter-clockwise, heading 0; reaches its
/// turn rate at constant acceleration after ramp_s.
TrajectoryPtr circle_trajectory(double radius_m, double turn_rate_radps, double ramp_s,
                                double duration_s);
/// Rose r = amplitude sin(petals angle) with the angle at a constant rate, heading 0, for 2 pi.
TrajectoryPtr rose_trajectory(double amplitude_m, int petals, double turn_rate_radps);
/// From the origin to `target` (x m, y m, heading rad) at once.
TrajectoryPtr step_trajectory(const Eigen::Vector3d& target, double duration_s);

/// The same path, `factor` times as fast (above 0).
TrajectoryPtr time_scaled(TrajectoryPtr trajectory, double factor);

/// The same motion elsewhere: its origin is put to `place` (x m, y m, heading rad) and the whole
/// path turned by its heading.
TrajectoryPtr placed(TrajectoryPtr trajectory, const Eigen::Vector3d& place);

/// What is left of a motion after `time_s` of it, from within its duration; it need not begin at
/// rest.
TrajectoryPtr rest_of(TrajectoryPtr trajectory, double time_s);

/// Largest share of the robot's limits that a trajectory asks for, looked at every millisecond.
struct TrajectoryDemand {
  double speed = 0.0;    ///< of max_speed_mps and max_turn_rate_radps
  double voltage = 0.0;  ///< of max_voltage_v, without jumps of the velocity
};
TrajectoryDemand trajectory_demand(const Trajectory& trajectory, const RobotModel& model);

}  // namespace nadir::control_client
