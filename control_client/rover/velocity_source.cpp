#include "control_client/rover/velocity_source.h"

#include <cmath>

namespace nadir::control_client {

VelocitySource::VelocitySource(const VelocitySettings& settings, const Eigen::Vector3d& inertia,
                               double tick_s)
    : settings_(settings),
      inertia_(inertia),
      tick_s_(tick_s),
      observer_(settings.observer, inertia, tick_s) {}

void VelocitySource::start(const fusion::PlanarPose& pose) {
  observer_.start(pose);
  last_ = pose;
  force_.setZero();
  velocity_.setZero();
  acceleration_.setZero();
}

Eigen::Vector3d VelocitySource::predict(const Eigen::Vector3d& force) {
  force_ = force;
  if (settings_.kind == VelocityKind::kDifferences) return tick_s_ * velocity_;
  return observer_.predict(force);
}

void VelocitySource::correct(const fusion::PlanarPose& measured) {
  if (settings_.kind == VelocityKind::kDifferences) {
    const Eigen::Vector3d before = velocity_;
    const double share = 1.0 - std::exp(-tick_s_ / settings_.smoothing_s);
    velocity_ += share * (fusion::pose_difference(measured, last_) / tick_s_ - velocity_);
    acceleration_ = (velocity_ - before) / tick_s_;
    last_ = measured;
    return;
  }
  observer_.correct(measured);
  velocity_ = observer_.velocity();
  acceleration_ = (force_ + observer_.disturbance()).cwiseQuotient(inertia_);
}

}  // namespace nadir::control_client
