#pragma once

#include <Eigen/Core>
#include <vector>

namespace nadir::vision {

/// Where a synthetic robot is and how it moves: true pose in the world and its rate of change.
struct RobotMotion {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;  ///< (-pi, pi]
  double velocity_x_mps = 0.0;
  double velocity_y_mps = 0.0;
  double heading_rate_radps = 0.0;
};

/// A path on the field, driven at constant speed and for ever.
struct RobotPath {
  enum class Kind { kStatic, kCircle, kPolyline };

  Kind kind = Kind::kStatic;
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();  ///< static: the place; circle: its centre
  double radius_m = 0.0;
  double start_angle_rad = 0.0;            ///< on the circle
  std::vector<Eigen::Vector2d> corners_m;  ///< polyline: at least two, no two neighbours equal
  bool closed = false;                     ///< polyline: drive round; else to and fro
  double speed_mps = 0.0;                  ///< circle: negative is clockwise
  double start_m = 0.0;                    ///< polyline: way already driven at time 0
  bool faces_travel = false;  ///< heading turns with the path (rounded 5 cm about corners)
  double heading_rad = 0.0;   ///< added to the direction of travel, or the heading itself
  double spin_radps = 0.0;    ///< added turn, if it does not face its travel

  /// Pose and velocity `time_s` after the scene's start.
  RobotMotion at(double time_s) const;
};

}  // namespace nadir::vision
