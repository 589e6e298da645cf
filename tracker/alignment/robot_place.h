#pragma once

#include <Eigen/Core>
#include <cmath>

#include "fusion/planar_pose.h"

namespace nadir::tracker {

/// A robot's pose in the world as points are moved with it: sine and cosine are found once.
class RobotPlace {
 public:
  RobotPlace() = default;
  explicit RobotPlace(const fusion::PlanarPose& pose)
      : pose_(pose), cosine_(std::cos(pose.heading_rad)), sine_(std::sin(pose.heading_rad)) {}

  const fusion::PlanarPose& pose() const { return pose_; }
  Eigen::Vector2d forward() const { return {cosine_, sine_}; }
  /// A vector of the robot's frame in the world's.
  Eigen::Vector2d turned(const Eigen::Vector2d& p) const {
    return {cosine_ * p.x() - sine_ * p.y(), sine_ * p.x() + cosine_ * p.y()};
  }
  /// A point of the robot's frame in the world's.
  Eigen::Vector2d point(const Eigen::Vector2d& p) const { return pose_.position_m() + turned(p); }
  /// d(point) / d(x, y, heading).
  Eigen::Matrix<double, 2, 3> lever(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d arm = turned(p);
    Eigen::Matrix<double, 2, 3> a;
    a << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x();
    return a;
  }
  RobotPlace moved(const Eigen::Vector3d& step) const {
    return RobotPlace({pose_.x_m + step.x(), pose_.y_m + step.y(),
                       fusion::wrap_angle(pose_.heading_rad + step.z())});
  }

 private:
  fusion::PlanarPose pose_;
  double cosine_ = 1.0;
  double sine_ = 0.0;
};

}  // namespace nadir::tracker
