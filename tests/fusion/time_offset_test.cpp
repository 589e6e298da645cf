// Latency that nobody declared: found by MotionLag and by TimeOffsetEstimator.

#include <gtest/gtest.h>

#include <cmath>

#include "fusion/delayed_fusion.h"
#include "fusion/motion_lag.h"
#include "fusion/time_offset_estimator.h"
#include "tests/fusion/wandering_robot.h"

namespace nadir::fusion {
namespace {

using test::WanderingRobot;

std::optional<LagReading> lag_of(WanderingRobot robot, double duration_s) {
  robot.drive(duration_s);
  MotionLag lag;
  std::size_t frame = 0;
  for (const auto& tick : robot.ticks) {
    lag.add_odometry(tick.from, tick.to, tick.odometry);
    for (; frame < robot.frames.size() && robot.frames[frame].stamp <= tick.to; ++frame) {
      lag.add_pose(robot.frames[frame].stamp, robot.frames[frame].pose);
    }
  }
  return lag.reading();
}

std::optional<TimeOffsetReading> offset_of(WanderingRobot robot, double duration_s) {
  robot.drive(duration_s);
  const double u2 = robot.walk_m_per_sqrt_s * robot.walk_m_per_sqrt_s;
  const double r2 = robot.walk_rad_per_sqrt_s * robot.walk_rad_per_sqrt_s;
  DelayedFusion<>::Settings settings;
  settings.filter.odometry_error =
      WhiteOdometryNoise(Eigen::Vector3d(u2, u2, r2).asDiagonal(), 1.0);
  DelayedFusion<> fusion(settings);
  TimeOffsetEstimator estimator;
  std::size_t frame = 0;
  for (const auto& tick : robot.ticks) {
    fusion.add_odometry({tick.from, tick.to, tick.odometry, {}});
    for (; frame < robot.frames.size() && robot.frames[frame].stamp <= tick.to; ++frame) {
      VisionPose pose{0,
                      0,
                      frame,
                      robot.frames[frame].stamp,
                      robot.frames[frame].pose,
                      robot.frame_covariance()};
      const Correction correction = fusion.add_pose(pose);
      estimator.add(pose.capture, pose.pose, pose.covariance, correction,
                    robot.rates_at(to_seconds(pose.capture) - 100.0));
    }
  }
  return estimator.reading();
}

TEST(MotionLag, FindsTheLeadOfCommandsWhateverTheirGain) {
  WanderingRobot robot;
  for (const double lead_s : {-0.12, 0.0, 0.2, 0.45}) {
    for (const double gain : {0.8, 1.1}) {
      robot.odometry_lead_s = lead_s;
      robot.odometry_gain = gain;
      ++robot.seed;
      const auto reading = lag_of(robot, 60.0);
      ASSERT_TRUE(reading) << lead_s;
      EXPECT_NEAR(reading->lag_s, lead_s, 0.005) << gain;
      EXPECT_NEAR(reading->lag_s, lead_s, 4.0 * reading->sigma_s) << gain;
      EXPECT_LT(reading->sigma_s, 0.004);
    }
  }
}

TEST(MotionLag, SeesTheSumOfLeadAndUndeclaredDelay) {
  WanderingRobot robot;
  robot.odometry_lead_s = 0.1;
  robot.undeclared_delay_s = 0.06;
  const auto reading = lag_of(robot, 60.0);
  ASSERT_TRUE(reading);
  EXPECT_NEAR(reading->lag_s, 0.16, 0.005);
}

TEST(MotionLag, SigmaHolds) {
  double squares = 0.0;
  constexpr int kRuns = 30;
  for (int run = 0; run < kRuns; ++run) {
    WanderingRobot robot;
    robot.seed = 100 + static_cast<std::uint64_t>(run);
    robot.odometry_lead_s = 0.155;
    const auto reading = lag_of(robot, 30.0);
    ASSERT_TRUE(reading);
    squares += std::pow((reading->lag_s - 0.155) / reading->sigma_s, 2);
  }
  // chi2(30) / 30 is below 1.7 in 99 % of all cases; a careful sigma may make it small.
  EXPECT_LT(squares / kRuns, 1.7);
  EXPECT_GT(squares / kRuns, 0.1);
}

TEST(MotionLag, SaysNothingOfARobotThatStandsOrRunsStraight) {
  WanderingRobot standing;
  standing.speed_mps = 0.0;
  EXPECT_FALSE(lag_of(standing, 30.0));
  WanderingRobot straight;
  straight.is_steady = true;
  EXPECT_FALSE(lag_of(straight, 30.0));
}

TEST(TimeOffsetEstimator, FindsTheDelayThatNobodyDeclared) {
  for (const double delay_s : {-0.04, -0.01, 0.0, 0.02, 0.06}) {
    WanderingRobot robot;
    robot.undeclared_delay_s = delay_s;
    const auto reading = offset_of(robot, 120.0);
    ASSERT_TRUE(reading);
    // The gate cuts the largest innovations, so that large delays look a little smaller.
    EXPECT_NEAR(reading->offset_s, delay_s, 0.003 + 0.1 * std::abs(delay_s)) << delay_s;
    EXPECT_LT(reading->sigma_s, 0.003);
  }
}

TEST(TimeOffsetEstimator, SigmaHolds) {
  double squares = 0.0;
  constexpr int kRuns = 20;
  for (int run = 0; run < kRuns; ++run) {
    WanderingRobot robot;
    robot.seed = 200 + static_cast<std::uint64_t>(run);
    robot.undeclared_delay_s = 0.01;
    const auto reading = offset_of(robot, 60.0);
    ASSERT_TRUE(reading);
    squares += std::pow((reading->offset_s - 0.01) / reading->sigma_s, 2);
  }
  EXPECT_LT(squares / kRuns, 1.9);  // chi2(20) / 20: 99 %
  EXPECT_GT(squares / kRuns, 0.1);
}

TEST(TimeOffsetEstimator, SaysNothingOfARobotThatStands) {
  WanderingRobot robot;
  robot.speed_mps = 0.0;
  const auto reading = offset_of(robot, 60.0);
  EXPECT_TRUE(!reading || reading->sigma_s > 0.02) << reading->sigma_s;
}

TEST(TimeOffsetEstimator, LeavesOutWhatTheFilterDidNotUse) {
  TimeOffsetEstimator estimator;
  Correction gated;
  gated.verdict = PoseVerdict::kGated;
  for (int i = 1; i < 1000; ++i) {
    estimator.add(from_seconds(0.1 * i), {0.1 * i, 0.0, 0.0}, PoseCovariance::Identity(), gated,
                  {1.0, 0.0, 0.0});
  }
  EXPECT_FALSE(estimator.reading());
}

}  // namespace
}  // namespace nadir::fusion
