#pragma once

#include <Eigen/Core>
#include <array>

#include "fusion/extended_state_observer.h"
#include "fusion/planar_pose.h"

namespace nadir::control_client {

/// From where a rover without encoders takes its velocity.
enum class VelocityKind {
  kDifferences,  ///< of its poses, smoothed
  kObserver,     ///< an extended state observer, which tells of disturbances as well
};

struct VelocitySettings {
  VelocityKind kind = VelocityKind::kObserver;
  std::array<fusion::ObserverGains, 3> observer;  ///< x, y, heading
  double smoothing_s = 0.2;                       ///< time constant of smoothed differences
};

/// Velocity, acceleration and disturbance from poses, one each tick. World frame; x, y, heading.
class VelocitySource {
 public:
  VelocitySource(const VelocitySettings& settings, const Eigen::Vector3d& inertia, double tick_s);

  void start(const fusion::PlanarPose& pose);
  /// A tick passes under a commanded force; the displacement that is expected.
  Eigen::Vector3d predict(const Eigen::Vector3d& force);
  void correct(const fusion::PlanarPose& measured);

  const Eigen::Vector3d& velocity() const { return velocity_; }
  const Eigen::Vector3d& acceleration() const { return acceleration_; }
  /// Zero where nothing observes it.
  const Eigen::Vector3d& disturbance() const { return observer_.disturbance(); }

 private:
  VelocitySettings settings_;
  Eigen::Vector3d inertia_;
  double tick_s_;
  fusion::ExtendedStateObserver observer_;
  fusion::PlanarPose last_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_ = Eigen::Vector3d::Zero();
};

}  // namespace nadir::control_client
