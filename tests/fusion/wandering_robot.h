#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "fusion/odometry.h"
#include "fusion/timestamp.h"
#include "tests/fusion/random_stream.h"

namespace nadir::fusion::test {

/// A robot whose velocity changes all the time, its odometry at 100 Hz and what a camera sees of it
/// at 25 Hz, both with white noise, and stamps that are wrong.
struct WanderingRobot {
  struct Tick {
    Timestamp from{0};
    Timestamp to{0};
    BodyRates odometry;
    PlanarPose truth;  ///< at `to`
  };
  struct Frame {
    Timestamp stamp{0};
    PlanarPose pose;
  };

  double speed_mps = 0.4;        ///< 0: stands
  bool is_steady = false;        ///< one speed, one direction
  double odometry_lead_s = 0.0;  ///< odometry tells what the robot will do so much later
  double odometry_gain = 1.0;
  double undeclared_delay_s = 0.0;  ///< frames are so much older than stamped
  double walk_m_per_sqrt_s = 0.004;
  double walk_rad_per_sqrt_s = 0.03;
  double sigma_m = 0.003;
  double sigma_rad = 0.02;
  std::uint64_t seed = 1;

  std::vector<Tick> ticks;
  std::vector<Frame> frames;

  BodyRates rates_at(double t_s) const {
    if (is_steady) return {speed_mps, 0.0, 0.0};
    return {speed_mps * (std::sin(1.3 * t_s) + 0.5 * std::sin(3.1 * t_s)),
            0.6 * speed_mps * std::cos(1.9 * t_s), 3.0 * speed_mps * std::sin(0.8 * t_s + 1.0)};
  }

  PoseCovariance frame_covariance() const {
    return Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad)
        .asDiagonal();
  }

  void drive(double duration_s) {
    constexpr double kTick_s = 0.01;
    RandomStream random(seed);
    std::vector<PlanarPose> path;  // one a tick, from a second before to a second after
    PlanarPose pose;
    for (int i = -100; i < duration_s / kTick_s + 100; ++i) {
      pose = moved(pose, rates_at((i - 0.5) * kTick_s), kTick_s);
      path.push_back(pose);
    }
    const auto pose_at = [&](double t_s) {
      const double place = t_s / kTick_s + 100.0;
      const auto index = static_cast<std::size_t>(place);
      const PlanarPose& a = path.at(index);
      const Eigen::Vector3d way = (place - static_cast<double>(index)) *
                                  pose_difference(path.at(std::min(index + 1, path.size() - 1)), a);
      return PlanarPose{a.x_m + way.x(), a.y_m + way.y(), wrap_angle(a.heading_rad + way.z())};
    };
    const Timestamp start = std::chrono::seconds(100);
    for (int i = 1; i < duration_s / kTick_s; ++i) {
      const double t_s = i * kTick_s;
      Eigen::Vector3d rates =
          odometry_gain * rates_at(t_s - 0.5 * kTick_s + odometry_lead_s).vector();
      const double per_tick = 1.0 / std::sqrt(kTick_s);
      rates += per_tick * Eigen::Vector3d(walk_m_per_sqrt_s * random.normal(),
                                          walk_m_per_sqrt_s * random.normal(),
                                          walk_rad_per_sqrt_s * random.normal());
      ticks.push_back({start + from_seconds(t_s - kTick_s), start + from_seconds(t_s),
                       BodyRates::from(rates), pose_at(t_s)});
      if (i % 4 != 0) continue;
      PlanarPose seen = pose_at(t_s - undeclared_delay_s);
      const Eigen::Vector3d noise = random.normal(frame_covariance());
      frames.push_back(
          {start + from_seconds(t_s),
           {seen.x_m + noise.x(), seen.y_m + noise.y(), wrap_angle(seen.heading_rad + noise.z())}});
    }
  }
};

}  // namespace nadir::fusion::test
