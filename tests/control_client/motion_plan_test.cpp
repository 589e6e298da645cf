// From wherever the robot stands, along its trajectory at any pace, to rest at its end.

#include "control_client/drive/motion_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace nadir::control_client {
namespace {

constexpr double kTick_s = 0.02;

class Plans : public testing::Test {
 protected:
  MotionPlan plan(const char* trajectory, const PlanSettings& settings = {}) {
    return {model_, control_, settings, standard_trajectory(trajectory)};
  }

  RobotModel model_{RobotParameters{}};
  ControlParameters control_;
};

/// Poses and velocities of a motion tick by tick, and whether they belong together.
class Smoothness {
 public:
  void see(const NominalMotion& motion) {
    if (has_last_) {
      const Eigen::Vector3d step = motion.pose - last_.pose;
      const Eigen::Vector3d mean = 0.5 * (motion.velocity_per_s + last_.velocity_per_s);
      mismatch_ = std::max(mismatch_, (step - kTick_s * mean).head<2>().norm());
      jump_ = std::max(jump_, (motion.velocity_per_s - last_.velocity_per_s).norm());
    }
    last_ = motion;
    has_last_ = true;
  }
  double mismatch_m() const { return mismatch_; }
  double velocity_jump() const { return jump_; }

 private:
  bool has_last_ = false;
  NominalMotion last_;
  double mismatch_ = 0.0;
  double jump_ = 0.0;
};

TEST_F(Plans, LeadFromAnywhereOntoTheTrajectoryWithoutAJump) {
  MotionPlan circle = plan("circle");
  circle.start_from({-0.4, 0.3, 3.0});
  EXPECT_EQ(circle.phase(), MotionPlan::Phase::kApproach);
  Smoothness smoothness;
  smoothness.see(circle.motion());
  EXPECT_NEAR(circle.motion().pose.x(), -0.4, 1e-12);
  for (int tick = 0; tick < 500; ++tick) {
    circle.advance(kTick_s, 1.0);
    smoothness.see(circle.motion());
  }
  EXPECT_EQ(circle.phase(), MotionPlan::Phase::kFollow);
  EXPECT_LT(smoothness.mismatch_m(), 3e-4);
  EXPECT_LT(smoothness.velocity_jump(), 0.12) << "6 m/s^2 and rad/s^2";
  EXPECT_NEAR(circle.motion().pose.head<2>().norm(), 0.25, 1e-9);
}

TEST_F(Plans, TurnTheShortWay) {
  MotionPlan circle = plan("circle");
  circle.start_from({0.25, 0.0, -3.0});
  double least = 0.0;
  double most = 0.0;
  for (int tick = 0; tick < 400; ++tick) {
    circle.advance(kTick_s, 1.0);
    least = std::min(least, circle.motion().pose.z());
    most = std::max(most, circle.motion().pose.z());
  }
  EXPECT_GE(least, -3.0 - 1e-9);
  EXPECT_LE(most, 1e-9);
}

TEST_F(Plans, PausedTimeLosesNothingOfThePath) {
  MotionPlan circle = plan("circle");
  circle.start_from({0.25, 0.0, 0.0});
  for (int tick = 0; tick < 300; ++tick) circle.advance(kTick_s, 1.0);
  Smoothness smoothness;
  for (int tick = 0; tick < 100; ++tick) {
    circle.advance(kTick_s, 0.0);
    smoothness.see(circle.motion());
  }
  const double paused_s = circle.trajectory_time_s();
  EXPECT_EQ(circle.motion().velocity_per_s.norm(), 0.0);
  for (int tick = 0; tick < 100; ++tick) circle.advance(kTick_s, 0.0);
  EXPECT_EQ(circle.trajectory_time_s(), paused_s);
  for (int tick = 0; tick < 100; ++tick) {
    circle.advance(kTick_s, 1.0);
    smoothness.see(circle.motion());
  }
  EXPECT_LT(smoothness.mismatch_m(), 3e-4);
  EXPECT_LT(smoothness.velocity_jump(), 0.03);
  EXPECT_NEAR(circle.trajectory_time_s() - paused_s, 2.0 - 0.25, 0.02)
      << "half of the ramp is lost";
}

TEST_F(Plans, AfterAStopGoOnWhereTheTrajectoryStood) {
  MotionPlan circle = plan("circle");
  circle.start_from({0.25, 0.0, 0.0});
  for (int tick = 0; tick < 300; ++tick) circle.advance(kTick_s, 1.0);
  const double stood_s = circle.trajectory_time_s();
  const Eigen::Vector3d stood = circle.motion().pose;
  circle.start_from({stood.x() + 0.1, stood.y() - 0.2, 0.3});  // carried away meanwhile
  while (circle.phase() == MotionPlan::Phase::kApproach) circle.advance(kTick_s, 1.0);
  EXPECT_EQ(circle.trajectory_time_s(), stood_s);
  EXPECT_LT((circle.motion().pose - stood).norm(), 1e-9);
}

TEST_F(Plans, ComeToRestAtTheEndOfATrajectoryThatDoesNot) {
  MotionPlan circle = plan("circle");
  circle.start_from({0.25, 0.0, 0.0});
  Smoothness smoothness;
  int ticks = 0;
  for (; circle.phase() != MotionPlan::Phase::kOver && ticks < 2000; ++ticks) {
    circle.advance(kTick_s, 1.0);
    smoothness.see(circle.motion());
  }
  EXPECT_LT(ticks, 1300);
  EXPECT_LT(smoothness.velocity_jump(), 0.05);
  EXPECT_EQ(circle.rounds(), 1);
  const Eigen::Vector3d end = standard_trajectory("circle")->at(100.0).pose;
  EXPECT_LT((circle.motion().pose - end).norm(), 1e-3);
}

TEST_F(Plans, RepeatFromTheirBeginning) {
  PlanSettings settings;
  settings.repeats = true;
  MotionPlan rose = plan("rose3", settings);
  rose.start_from({0.0, 0.0, 0.0});
  Smoothness smoothness;
  for (int tick = 0; tick < 50 * 80; ++tick) {
    rose.advance(kTick_s, 1.0);
    smoothness.see(rose.motion());
  }
  EXPECT_EQ(rose.rounds(), 2);
  EXPECT_LT(smoothness.mismatch_m(), 3e-4);
}

TEST_F(Plans, FollowThroughACommandFilterToo) {
  PlanSettings settings;
  settings.nominal.kind = NominalKind::kFiltered;
  MotionPlan square = plan("square", settings);
  square.start_from({-0.25, -0.25, 0.0});
  Smoothness smoothness;
  for (int tick = 0; tick < 50 * 25; ++tick) {
    square.advance(kTick_s, tick % 200 < 100 ? 1.0 : 0.4);
    smoothness.see(square.motion());
  }
  EXPECT_LT(smoothness.velocity_jump(), 0.1) << "a corner does not jump";
}

TEST(Trajectories, ArePutSomewhereElse) {
  const TrajectoryPtr circle = standard_trajectory("circle");
  const TrajectoryPtr moved = placed(circle, {1.0, 2.0, M_PI / 2.0});
  const TrajectoryPoint here = circle->at(7.0);
  const TrajectoryPoint there = moved->at(7.0);
  EXPECT_NEAR(there.pose.x(), 1.0 - here.pose.y(), 1e-12);
  EXPECT_NEAR(there.pose.y(), 2.0 + here.pose.x(), 1e-12);
  EXPECT_NEAR(there.pose.z(), here.pose.z() + M_PI / 2.0, 1e-12);
  EXPECT_NEAR(there.velocity_per_s.x(), -here.velocity_per_s.y(), 1e-12);
  EXPECT_NEAR(there.acceleration_per_s2.y(), here.acceleration_per_s2.x(), 1e-12);
  EXPECT_EQ(moved->duration_s(), circle->duration_s());
}

TEST(Trajectories, ThatAreTooFastAreSlowedDownUntilTheyFit) {
  const RobotModel model{RobotParameters{}};
  EXPECT_EQ(fitting_trajectory("circle", model)->duration_s(),
            standard_trajectory("circle")->duration_s());
  const TrajectoryPtr fitted = fitting_trajectory("circle", model, 20.0);
  const TrajectoryDemand demand = trajectory_demand(*fitted, model);
  EXPECT_LE(std::max(demand.speed, demand.voltage), 1.0);
  EXPECT_GT(std::max(demand.speed, demand.voltage), 0.9) << "not slower than needed";
  const double share = 0.3;
  EXPECT_LT((fitted->at(share * fitted->duration_s()).pose -
             standard_trajectory("circle")->at(share * 20.0).pose)
                .norm(),
            1e-9)
      << "the same path";
}

TEST(Trajectories, TheRestOfOneIsItsEnd) {
  const TrajectoryPtr circle = standard_trajectory("circle");
  const TrajectoryPtr rest = rest_of(circle, 5.0);
  EXPECT_DOUBLE_EQ(rest->duration_s(), circle->duration_s() - 5.0);
  EXPECT_EQ(rest->at(1.5).pose, circle->at(6.5).pose);
  EXPECT_EQ(rest->at(100.0).pose, circle->at(100.0).pose);
}

}  // namespace
}  // namespace nadir::control_client
