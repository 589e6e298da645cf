#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "control_client/rover/potential_field.h"
#include "control_client/rover/rover_model.h"
#include "control_client/rover/velocity_controller.h"
#include "control_client/rover/velocity_source.h"
#include "fusion/slam/ekf_slam.h"

namespace nadir::control_client {

struct NavigatorSettings {
  double tick_s = 0.05;
  RoverParameters rover;
  VelocitySettings velocity;
  /// The map's prediction moves by the commanded velocity instead of the estimated one.
  bool predicts_by_command = false;
  /// One sigma of the velocity by which it moves, for a tick: m/s, m/s, rad/s.
  Eigen::Vector3d velocity_sigma{0.05, 0.05, 0.05};
  VelocityGains gains;
  PotentialField field;
  double heading_rate_per_s = 1.0;  ///< the heading is led to 0: r_c = -rate heading
  double reach_m = 0.2;             ///< of way points
  fusion::EkfSlam<>::Settings slam;
  /// Landmarks seen at one tick correct the map one after the other, each from where the last one
  /// left it (S4), instead of all at once.
  bool corrects_one_by_one = false;
};

/// S4's rover, onboard: it maps landmarks, takes its velocity and its disturbances from the poses
/// that come of it, and drives a tour among them. A tick: predict -> see -> observe -> guide ->
/// push.
class RoverNavigator {
 public:
  RoverNavigator(const NavigatorSettings& settings, std::vector<Eigen::Vector2d> way_points_m);

  /// At rest at a pose that is known so well.
  void start(const fusion::PlanarPose& pose, const fusion::PoseCovariance& covariance);

  /// A tick has passed since the last call (the first is at the start): what was seen now,
  /// landmarks with names. Returns the wheel forces (N) until the next tick.
  Eigen::Vector3d tick(std::span<const fusion::Sighting> seen);

  const fusion::EkfSlam<>& slam() const { return slam_; }
  const VelocitySource& velocity() const { return velocity_; }
  const WaypointTour& tour() const { return tour_; }
  /// Of what was seen at the last tick.
  const std::vector<fusion::SightingReport>& reports() const { return reports_; }

 private:
  void predict();
  void observe(std::span<const fusion::Sighting> seen);
  Eigen::Vector3d commanded_velocity();

  NavigatorSettings settings_;
  RoverModel model_;
  fusion::EkfSlam<> slam_;
  VelocitySource velocity_;
  VelocityController controller_;
  WaypointTour tour_;
  std::vector<fusion::SightingReport> reports_;
  bool has_moved_ = false;
  Eigen::Vector3d command_ = Eigen::Vector3d::Zero();  // velocity
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();    // commanded, world frame
};

}  // namespace nadir::control_client
