#include "fusion/odometry.h"

#include <cmath>

#include "fusion/sine_cosine.h"

namespace nadir::fusion {
namespace {

// sin(x)/x and its derivative.
struct Chord {
  double share = 1.0;
  double slope = 0.0;
};

Chord chord(double x) {
  const double y = x * x;
  if (y < 0.25) {
    return {
        1.0 + y * (-1.0 / 6 + y * (1.0 / 120 +
                                   y * (-1.0 / 5040 + y * (1.0 / 362880 + y * (-1.0 / 39916800))))),
        x * (-1.0 / 3 +
             y * (1.0 / 30 + y * (-1.0 / 840 + y * (1.0 / 45360 + y * (-1.0 / 3991680)))))};
  }
  const SineCosine at = sine_cosine(x);
  return {at.sine / x, (at.cosine - at.sine / x) / x};
}

}  // namespace

Eigen::Matrix3d Motion::by_pose() const {
  Eigen::Matrix3d derivative = Eigen::Matrix3d::Identity();
  derivative(0, 2) = -displacement_world_m.y();
  derivative(1, 2) = displacement_world_m.x();
  return derivative;
}

Motion constant_rate_motion(double heading_rad, const BodyRates& rates, double dt_s) {
  const double half_turn_rad = 0.5 * dt_s * rates.r_radps;
  const SineCosine middle = sine_cosine(heading_rad + half_turn_rad);
  const Chord arc = chord(half_turn_rad);
  const double forward_x = middle.cosine * rates.u_mps - middle.sine * rates.v_mps;
  const double forward_y = middle.sine * rates.u_mps + middle.cosine * rates.v_mps;
  const double share_s = dt_s * arc.share;

  Motion motion;
  motion.displacement_world_m = {share_s * forward_x, share_s * forward_y};
  motion.turn_rad = dt_s * rates.r_radps;
  // The yaw rate turns the chord by half of what it turns the robot, and shortens it.
  const double half_dt_s = 0.5 * dt_s;
  const double shorter_s2 = half_dt_s * dt_s * arc.slope;
  motion.by_rates << share_s * middle.cosine, -share_s * middle.sine,
      shorter_s2 * forward_x - half_dt_s * motion.displacement_world_m.y(), share_s * middle.sine,
      share_s * middle.cosine, shorter_s2 * forward_y + half_dt_s * motion.displacement_world_m.x(),
      0.0, 0.0, dt_s;
  return motion;
}

PlanarPose moved(const PlanarPose& pose, const Motion& motion) {
  return {pose.x_m + motion.displacement_world_m.x(), pose.y_m + motion.displacement_world_m.y(),
          wrap_angle(pose.heading_rad + motion.turn_rad)};
}

}  // namespace nadir::fusion
