#include "control_client/differential/unicycle.h"

#include <cmath>
#include <numbers>

namespace nadir::control_client {
namespace {

constexpr double kStanding_mps = 1e-9;

double sinc(double x) { return std::abs(x) < 1e-4 ? 1.0 - x * x / 6.0 : std::sin(x) / x; }

}  // namespace

WheelSpeeds wheel_speeds(const UnicycleMotion& motion, double track_m) {
  const double half_mps = 0.5 * track_m * motion.turn_rate_radps;
  return {motion.speed_mps - half_mps, motion.speed_mps + half_mps};
}

UnicycleMotion motion_of(const WheelSpeeds& wheels, double track_m) {
  return {0.5 * (wheels.right_mps + wheels.left_mps),
          (wheels.right_mps - wheels.left_mps) / track_m};
}

fusion::PlanarPose moved(const fusion::PlanarPose& pose, const UnicycleMotion& motion,
                         double dt_s) {
  const double turn_rad = motion.turn_rate_radps * dt_s;
  const double chord_m = motion.speed_mps * dt_s * sinc(0.5 * turn_rad);
  const double direction_rad = pose.heading_rad + 0.5 * turn_rad;
  return {pose.x_m + chord_m * std::cos(direction_rad),
          pose.y_m + chord_m * std::sin(direction_rad),
          fusion::wrap_angle(pose.heading_rad + turn_rad)};
}

UnicycleReference reference_along(const TrajectoryPoint& point, bool backwards,
                                  double heading_at_rest_rad) {
  const Eigen::Vector2d v = point.velocity_per_s.head<2>();
  const Eigen::Vector2d a = point.acceleration_per_s2.head<2>();
  UnicycleReference reference;
  reference.pose = {point.pose.x(), point.pose.y(), fusion::wrap_angle(heading_at_rest_rad)};
  const double speed_mps = v.norm();
  if (speed_mps < kStanding_mps) return reference;
  const double direction_rad = std::atan2(v.y(), v.x());
  reference.pose.heading_rad =
      fusion::wrap_angle(backwards ? direction_rad + std::numbers::pi : direction_rad);
  reference.motion = {backwards ? -speed_mps : speed_mps,
                      (v.x() * a.y() - v.y() * a.x()) / v.squaredNorm()};
  return reference;
}

Eigen::Vector3d tracking_error(const UnicycleReference& reference, const fusion::PlanarPose& pose) {
  const Eigen::Vector2d away_m = reference.pose.position_m() - pose.position_m();
  const double c = std::cos(pose.heading_rad);
  const double s = std::sin(pose.heading_rad);
  return {c * away_m.x() + s * away_m.y(), -s * away_m.x() + c * away_m.y(),
          fusion::wrap_angle(reference.pose.heading_rad - pose.heading_rad)};
}

}  // namespace nadir::control_client
