// The robot with two driven wheels and the onboard process: what it steers, where it turns, and
// what its simulation does.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <vector>

#include "control_client/differential/corner_turns.h"
#include "control_client/differential/differential_base.h"
#include "control_client/differential/unicycle_steering.h"
#include "control_client/drive/motion_plan.h"
#include "control_client/drive/robot_kinds.h"
#include "tests/vision/scratch_folder.h"
#include "vision/input/input_error.h"

namespace nadir::control_client {
namespace {

using namespace std::chrono_literals;
constexpr double kPi = std::numbers::pi;

TEST(UnicycleSteering, ConvergesForwardsBackwardsAndHoldsItsHeadingAtRest) {
  const DifferentialParameters robot;
  for (const double speed_mps : {0.1, -0.1, 0.3, 0.0}) {
    UnicycleSteering steering(robot.weights, robot.limits);
    NominalMotion motion{{0.0, 0.0, 0.4},
                         {speed_mps * std::cos(0.4), speed_mps * std::sin(0.4), 0.0}};
    fusion::PlanarPose pose{0.0, speed_mps == 0.0 ? 0.0 : 0.08, 1.0};
    for (int k = 0; k < 2000; ++k) {
      const Eigen::Vector3d rates = steering.body_rates(pose, motion, 0.02);
      EXPECT_EQ(rates.y(), 0.0);
      pose = moved(pose, {rates.x(), rates.z()}, 0.02);
      motion.pose += 0.02 * motion.velocity_per_s;
    }
    const Eigen::Vector3d off(pose.x_m - motion.pose.x(), pose.y_m - motion.pose.y(),
                              pose.heading_rad - 0.4);
    EXPECT_LT(off.norm(), 1e-3) << speed_mps;
  }
}

TEST(CornerTurns, StandAndTurnWhereTheHeadingJumps) {
  const TrajectoryPtr square = standard_trajectory("square-along");
  const TrajectoryPtr turning = with_corner_turns("square-along", square, {});
  const double turn_s = (turning->duration_s() - square->duration_s()) / 3.0;
  EXPECT_GT(turn_s, 0.5);
  double largest_step_rad = 0.0;
  double largest_step_m = 0.0;
  for (double t = 0.0; t < turning->duration_s(); t += 0.01) {
    const Eigen::Vector3d step = turning->at(t + 0.01).pose - turning->at(t).pose;
    largest_step_rad = std::max(largest_step_rad, std::abs(step.z()));
    largest_step_m = std::max(largest_step_m, step.head<2>().norm());
  }
  EXPECT_LT(largest_step_rad, 0.01 * MotionLimits{}.turn_rate_radps + 1e-6);
  EXPECT_LT(largest_step_m, 0.00101);
  const TrajectoryPoint in_corner = turning->at(10.0 + 0.5 * turn_s);
  EXPECT_NEAR(in_corner.pose.z(), kPi / 4.0, 0.01);
  EXPECT_LT(in_corner.velocity_per_s.head<2>().norm(), 1e-9);
  EXPECT_LT((turning->at(turning->duration_s()).pose - square->at(40.0).pose).norm(), 1e-6);
}

TEST(CornerTurns, LeaveASmoothPathAloneAndRefuseToMoveSideways) {
  const TrajectoryPtr circles = standard_trajectory("two-circles");
  EXPECT_EQ(with_corner_turns("two-circles", circles, {}), circles);
  for (const char* name : {"circle", "square", "rose3"}) {
    EXPECT_THROW(with_corner_turns(name, standard_trajectory(name), {}), vision::InputError)
        << name;
  }
}

TEST(TurningApproach, NeverMovesSidewaysAndEndsOnTheTrajectory) {
  const RobotModel model{RobotParameters{}};
  PlanSettings settings;
  settings.moves_sideways = false;
  for (const fusion::PlanarPose& start :
       {fusion::PlanarPose{1.2, 1.0, 2.0}, {-0.4, 0.5, 0.1}, {1.5, 0.5, -0.1}, {0.5, 0.5, 3.0}}) {
    MotionPlan plan(model, {}, settings, standard_trajectory("two-circles"));
    plan.start_from(start);
    Eigen::Vector3d last = plan.motion().pose;
    EXPECT_LT(std::abs(fusion::wrap_angle(last.z() - start.heading_rad)), 1e-9);
    for (int k = 0; k < 3000 && plan.phase() == MotionPlan::Phase::kApproach; ++k) {
      plan.advance(0.02, 1.0);
      EXPECT_LT(std::abs(plan.motion().body_rates().y()), 1e-3);
      EXPECT_LT((plan.motion().pose - last).norm(), 0.05) << "a jump";
      last = plan.motion().pose;
    }
    EXPECT_EQ(plan.phase(), MotionPlan::Phase::kFollow);
    EXPECT_LT((last - Eigen::Vector3d(0.5, 0.5, 0.0)).norm(), 0.01);
  }
}

TEST(DifferentialBase, ReachesItsSpeedReportsItAndStopsWithoutCommands) {
  SimulationSettings settings;
  settings.encoders.kind = EncoderKind::kPerfect;
  fusion::Timestamp now = 10s;
  DifferentialBase base({}, settings, now, {});
  tracker::WireWheelCommand command;
  command.kind = tracker::WheelCommandKind::kRimSpeeds;
  command.wheels.count = 2;
  command.wheels.values[0] = 0.17;  // left
  command.wheels.values[1] = 0.23;
  command.valid_for_ns = 100'000'000;
  std::vector<OdometryInterval> odometry;
  fusion::PlanarPose counted;
  for (int k = 0; k < 50; ++k) {
    base.command(command, now);
    now += 20ms;
    base.take_odometry(now, &odometry);
    EXPECT_EQ(odometry.size(), 4U);
    for (const OdometryInterval& each : odometry) {
      EXPECT_EQ(each.mean_rates.v_mps, 0.0);
      counted = moved(counted, {each.mean_rates.u_mps, each.mean_rates.r_radps}, 0.005);
    }
  }
  EXPECT_NEAR(base.motion().speed_mps, 0.2, 1e-6);
  EXPECT_NEAR(base.motion().turn_rate_radps, 0.2, 1e-6);
  const fusion::PlanarPose truth = *base.truth_at(now);
  EXPECT_NEAR(truth.x_m, counted.x_m, 1e-9);
  EXPECT_NEAR(truth.heading_rad, counted.heading_rad, 1e-9);
  EXPECT_NEAR(truth.heading_rad, 0.2 * (1.0 - 0.05), 0.002);  // a lag behind
  base.take_odometry(now + 1s, &odometry);
  EXPECT_LT(std::abs(base.motion().speed_mps), 1e-6);
}

TEST(RobotKinds, AreWhatTheFileSaysAndMustAgree) {
  const vision::ScratchFolder folder;
  const auto file = folder.write("two.yaml", "type: differential\ntrack_m: 0.2\n");
  EXPECT_FALSE(load_driven_robot("", file).takes_volts);
  EXPECT_EQ(load_driven_robot("differential", file).geometry->wheels(), 2);
  EXPECT_THROW(load_driven_robot("omnidirectional", file), vision::InputError);
  EXPECT_THROW(load_driven_robot("hovercraft", {}), vision::InputError);
  EXPECT_THROW(load_robot(file), vision::InputError);
  const auto wrong = folder.write("wrong.yaml", "type: differential\ntrack_m: -1\n");
  EXPECT_THROW(load_driven_robot("", wrong), vision::InputError);
  EXPECT_TRUE(load_driven_robot("", {}).takes_volts);
}

TEST(RobotKinds, OnBoardTheInnerLoopToleratesSlip) {
  EXPECT_EQ(load_robot(NADIR_DATA_DIR "/robots/omni3.yaml").control.inner.natural_frequency_radps,
            20.0);
  for (const std::filesystem::path file : {"", NADIR_DATA_DIR "/robots/omni3.yaml"}) {
    EXPECT_NEAR(load_driven_robot("", file).config.control.inner.natural_frequency_radps, 7.203,
                1e-3)
        << file;
  }
}

TEST(RobotKinds, TheFileOfTheHouseIsTheDefault) {
  const DifferentialParameters file = load_differential_parameters(
      std::filesystem::path(NADIR_DATA_DIR) / "robots/differential.yaml");
  const DifferentialParameters usual;
  EXPECT_EQ(file.name, usual.name);
  EXPECT_EQ(file.track_m, usual.track_m);
  EXPECT_EQ(file.limits.speed_mps, usual.limits.speed_mps);
  EXPECT_EQ(file.limits.turn_rate_radps, usual.limits.turn_rate_radps);
  EXPECT_EQ(file.wheel_lag_s, usual.wheel_lag_s);
  EXPECT_EQ(file.weights.side, usual.weights.side);
  EXPECT_EQ(file.weights.heading, usual.weights.heading);
}

}  // namespace
}  // namespace nadir::control_client
