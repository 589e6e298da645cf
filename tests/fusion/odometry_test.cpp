#include "fusion/odometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/fusion/random_stream.h"

namespace nadir::fusion {
namespace {

constexpr double kPi = std::numbers::pi;

BodyRates random_rates(test::RandomStream& random) {
  return {random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0), random.uniform(-17.0, 17.0)};
}

Eigen::Vector3d vector(const PlanarPose& pose) { return {pose.x_m, pose.y_m, pose.heading_rad}; }

TEST(Odometry, DrivesAQuarterOfACircle) {
  // 1 m/s forward at 2 rad/s is a circle of 0.5 m; from the origin along x to its right-angle
  // point.
  const PlanarPose end = moved({0.0, 0.0, 0.0}, {1.0, 0.0, 2.0}, kPi / 4.0);
  EXPECT_NEAR(end.x_m, 0.5, 1e-15);
  EXPECT_NEAR(end.y_m, 0.5, 1e-15);
  EXPECT_NEAR(end.heading_rad, kPi / 2.0, 1e-15);
}

TEST(Odometry, MovesSidewaysAlongTheRobotsLeft) {
  const PlanarPose end = moved({1.0, 2.0, kPi / 2.0}, {0.0, 0.3, 0.0}, 2.0);
  EXPECT_NEAR(end.x_m, 0.4, 1e-15);
  EXPECT_NEAR(end.y_m, 2.0, 1e-15);
  EXPECT_DOUBLE_EQ(end.heading_rad, kPi / 2.0);
}

TEST(Odometry, HeadingStaysWrapped) {
  const PlanarPose end = moved({0.0, 0.0, 3.0}, {0.0, 0.0, 1.0}, 0.5);
  EXPECT_NEAR(end.heading_rad, 3.5 - 2.0 * kPi, 1e-15);
}

TEST(Odometry, OneStepEndsWhereManyPartsOfItDo) {
  test::RandomStream random(2);
  for (int run = 0; run < 200; ++run) {
    const BodyRates rates = random_rates(random);
    const PlanarPose start{0.3, -0.2, random.uniform(-kPi, kPi)};
    const double dt_s = random.uniform(0.001, 0.4);
    PlanarPose parts = start;
    double left_s = dt_s;
    for (int i = 0; i < 4; ++i) {
      const double part_s = random.uniform(0.0, left_s);
      parts = moved(parts, rates, part_s);
      left_s -= part_s;
    }
    parts = moved(parts, rates, left_s);
    EXPECT_LT(pose_difference(parts, moved(start, rates, dt_s)).norm(), 1e-14);
  }
}

TEST(Odometry, SmallTurnsAreAsExactAsLargeOnes) {
  // Both branches of the chord agree where they meet: x = r dt / 2 = 0.5.
  const Motion below = constant_rate_motion(0.4, {1.0, 0.5, 1.0 - 1e-12}, 1.0);
  const Motion above = constant_rate_motion(0.4, {1.0, 0.5, 1.0 + 1e-12}, 1.0);
  EXPECT_LT((below.displacement_world_m - above.displacement_world_m).norm(), 1e-11);
  EXPECT_LT((below.by_rates - above.by_rates).norm(), 1e-10);
}

TEST(Odometry, DerivativesAreThoseOfFiniteDifferences) {
  test::RandomStream random(3);
  constexpr double kStep = 1e-6;
  for (int run = 0; run < 200; ++run) {
    const BodyRates rates = random_rates(random);
    const PlanarPose start{0.1, 0.2, random.uniform(-1.0, 1.0)};
    const double dt_s = random.uniform(0.001, 0.1);
    const Motion motion = constant_rate_motion(start.heading_rad, rates, dt_s);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d by_rate =
          pose_difference(moved(start, BodyRates::from(rates.vector() + step), dt_s),
                          moved(start, BodyRates::from(rates.vector() - step), dt_s)) /
          (2.0 * kStep);
      EXPECT_LT((motion.by_rates.col(i) - by_rate).norm(), 1e-9);
      const Eigen::Vector3d plus = vector(start) + step;
      const Eigen::Vector3d minus = vector(start) - step;
      const Eigen::Vector3d by_start =
          pose_difference(moved({plus.x(), plus.y(), plus.z()}, rates, dt_s),
                          moved({minus.x(), minus.y(), minus.z()}, rates, dt_s)) /
          (2.0 * kStep);
      EXPECT_LT((motion.by_pose().col(i) - by_start).norm(), 1e-9);
    }
  }
}

}  // namespace
}  // namespace nadir::fusion
