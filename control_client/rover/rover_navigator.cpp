#include "control_client/rover/rover_navigator.h"

#include <utility>

namespace nadir::control_client {

RoverNavigator::RoverNavigator(const NavigatorSettings& settings,
                               std::vector<Eigen::Vector2d> way_points_m)
    : settings_(settings),
      model_(settings.rover),
      slam_(settings.slam),
      velocity_(settings.velocity, model_.inertia(), settings.tick_s),
      controller_(settings.gains, settings.tick_s),
      tour_(std::move(way_points_m), settings.reach_m) {}

void RoverNavigator::start(const fusion::PlanarPose& pose,
                           const fusion::PoseCovariance& covariance) {
  slam_.start(pose, covariance);
  velocity_.start(pose);
  controller_.restart();
  has_moved_ = false;
}

void RoverNavigator::predict() {
  const Eigen::Vector3d expected = velocity_.predict(force_);
  const Eigen::Vector3d displacement =
      settings_.predicts_by_command ? settings_.tick_s * command_ : expected;
  const Eigen::Vector3d sigma = settings_.tick_s * settings_.velocity_sigma;
  slam_.move(displacement, sigma.cwiseAbs2().asDiagonal());
}

void RoverNavigator::observe(std::span<const fusion::Sighting> seen) {
  reports_.resize(seen.size());
  if (!settings_.corrects_one_by_one) {
    slam_.observe(seen, reports_);
    return;
  }
  const std::span<fusion::SightingReport> reports(reports_);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    slam_.observe(seen.subspan(i, 1), reports.subspan(i, 1));
  }
}

Eigen::Vector3d RoverNavigator::commanded_velocity() {
  const Eigen::Vector2d here = slam_.pose().position_m();
  Eigen::Vector2d v = settings_.field.attraction_mps(here, tour_.next(here));
  for (int i = 0; i < slam_.landmarks(); ++i) {
    v += settings_.field.repulsion_mps(here, slam_.landmark_m(i));
  }
  return {v.x(), v.y(), -settings_.heading_rate_per_s * slam_.pose().heading_rad};
}

Eigen::Vector3d RoverNavigator::tick(std::span<const fusion::Sighting> seen) {
  if (has_moved_) predict();
  observe(seen);
  if (has_moved_) velocity_.correct(slam_.pose());
  has_moved_ = true;
  command_ = commanded_velocity();
  const Eigen::Vector3d wanted =
      controller_.force(command_, velocity_.velocity(), velocity_.acceleration());
  const double heading_rad = slam_.pose().heading_rad;
  Eigen::Vector3d wheels = model_.wheel_forces(heading_rad, wanted - velocity_.disturbance());
  force_ = model_.wheel_matrix(heading_rad) * wheels;
  return wheels;
}

}  // namespace nadir::control_client
