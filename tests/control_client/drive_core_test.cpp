// The onboard process in simulated time: it drives, and it gets over everything that happens to it.

#include "control_client/drive/drive_core.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/control_client/drive_rehearsal.h"

namespace nadir::control_client {
namespace {

using tracker::ClientMode;
using tracker::ClientReason;

struct Quality {
  double position_rms_m = 0.0;
  double heading_rms_rad = 0.0;
  double tracking_rms_m = 0.0;
};

Quality quality_of(const std::vector<RehearsalRow>& rows) {
  Quality quality;
  double estimated = 0.0;
  double followed = 0.0;
  for (const RehearsalRow& row : rows) {
    if (!row.estimate) continue;
    const Eigen::Vector3d error = fusion::pose_difference(row.estimate->pose, row.truth);
    quality.position_rms_m += error.head<2>().squaredNorm();
    quality.heading_rms_rad += error.z() * error.z();
    estimated += 1.0;
    if (row.phase != MotionPlan::Phase::kFollow) continue;
    quality.tracking_rms_m += (row.truth.position_m() - row.nominal.pose.head<2>()).squaredNorm();
    followed += 1.0;
  }
  quality.position_rms_m = std::sqrt(quality.position_rms_m / estimated);
  quality.heading_rms_rad = std::sqrt(quality.heading_rms_rad / estimated);
  quality.tracking_rms_m = std::sqrt(quality.tracking_rms_m / followed);
  return quality;
}

/// Whether some row has this mode and reason.
bool was(const std::vector<RehearsalRow>& rows, ClientMode mode, ClientReason reason) {
  return std::ranges::any_of(rows, [&](const RehearsalRow& row) {
    return row.verdict.mode == mode && row.verdict.reason == reason;
  });
}

bool drives_at_the_end(const std::vector<RehearsalRow>& rows) {
  return rows.back().verdict.mode == ClientMode::kDriving;
}

double way_m(const std::vector<RehearsalRow>& rows) {
  return (rows.back().truth.position_m() - rows.front().truth.position_m()).norm();
}

DriveSettings repeating() {
  DriveSettings settings;
  settings.plan.repeats = true;
  return settings;
}

Rehearsal on(const char* trajectory, std::uint64_t seed = 1) {
  return {repeating(), standard_trajectory(trajectory), seed};
}

/// Over the draws of twelve robots' wheels, 30 s each; `worst`: the largest of each figure.
struct ManyQualities {
  Quality mean, worst;
};

ManyQualities qualities(const char* trajectory, const DriveSettings& settings) {
  constexpr std::uint64_t kRobots = 12;
  ManyQualities all;
  for (std::uint64_t seed = 1; seed <= kRobots; ++seed) {
    Rehearsal rehearsal(settings, standard_trajectory(trajectory), seed);
    rehearsal.run(1.0);
    const Quality quality = quality_of(rehearsal.run(30.0));
    for (double Quality::*figure :
         {&Quality::position_rms_m, &Quality::heading_rms_rad, &Quality::tracking_rms_m}) {
      all.mean.*figure += quality.*figure / kRobots;
      all.worst.*figure = std::max(all.worst.*figure, quality.*figure);
    }
  }
  return all;
}

// Whatever wheels the robot has: a slip that a stiff inner loop amplifies must not swing it, and
// what the filter learns of the wheels must not mislead it where they slip hard.
TEST(DriveCore, DrivesWithAnyWheels) {
  constexpr double kDegree = M_PI / 180.0;
  for (const char* trajectory : {"circle", "rose3", "rose4"}) {
    const auto [mean, worst] = qualities(trajectory, repeating());
    EXPECT_LT(mean.position_rms_m, 0.0007) << trajectory;
    EXPECT_LT(mean.heading_rms_rad, 0.25 * kDegree) << trajectory;
    EXPECT_LT(mean.tracking_rms_m, 0.0015) << trajectory;
    EXPECT_LT(worst.position_rms_m, 0.001) << trajectory;
    EXPECT_LT(worst.heading_rms_rad, 0.4 * kDegree) << trajectory;
    EXPECT_LT(worst.tracking_rms_m, 0.002) << trajectory;
  }
  for (const char* trajectory : {"square-turning", "square"}) {
    const auto [mean, worst] = qualities(trajectory, repeating());
    EXPECT_LT(mean.position_rms_m, 0.0013) << trajectory;
    EXPECT_LT(mean.heading_rms_rad, 0.5 * kDegree) << trajectory;
    EXPECT_LT(mean.tracking_rms_m, 0.003) << trajectory;
    EXPECT_LT(worst.position_rms_m, 0.002) << trajectory;
    EXPECT_LT(worst.heading_rms_rad, 0.9 * kDegree) << trajectory;
    EXPECT_LT(worst.tracking_rms_m, 0.004) << trajectory;
  }
}

TEST(DriveCore, KnowingItsWheelsIsBetterThanWhiteNoise) {
  DriveSettings white = repeating();
  white.fusion.model = OdometryModel::kWhite;
  for (const char* trajectory : {"circle", "square-turning"}) {
    const Quality learnt = qualities(trajectory, repeating()).mean;
    const Quality constant = qualities(trajectory, white).mean;
    EXPECT_LT(learnt.position_rms_m, constant.position_rms_m) << trajectory;
    EXPECT_LT(learnt.heading_rms_rad, constant.heading_rms_rad) << trajectory;
  }
}

TEST(DriveCore, AStiffInnerLoopSwingsOnSlippingWheels) {
  DriveSettings stiff = repeating();
  stiff.control.tolerated_slip_s = 0.0;
  EXPECT_GT(qualities("circle", stiff).mean.heading_rms_rad,
            1.5 * qualities("circle", repeating()).mean.heading_rms_rad);
}

TEST(DriveCore, KnowsWhereItIsAndFollowsEveryTrajectory) {
  for (const char* trajectory : {"square-turning", "square", "circle", "rose3", "rose4"}) {
    Rehearsal rehearsal = on(trajectory);
    rehearsal.run(1.0);
    const Quality quality = quality_of(rehearsal.run(20.0));
    EXPECT_LT(quality.position_rms_m, 0.002) << trajectory;
    EXPECT_LT(quality.heading_rms_rad, 0.75 * M_PI / 180.0) << trajectory;
    EXPECT_LT(quality.tracking_rms_m, 0.004) << trajectory;
    EXPECT_EQ(rehearsal.core().state().counts.ticks_missed, 0U);
  }
}

TEST(DriveCore, TheSameEventsGiveTheSameDrive) {
  Rehearsal first = on("rose3", 5);
  Rehearsal second = on("rose3", 5);
  first.run(5.0);
  second.run(5.0);
  EXPECT_EQ(first.base().plant().pose(), second.base().plant().pose());
  Rehearsal other = on("rose3", 6);
  other.run(5.0);
  EXPECT_NE(first.base().plant().pose(), other.base().plant().pose());
}

TEST(DriveCore, RobotsWithFirmwareGetRimSpeedsOrBodyRates) {
  for (const auto output :
       {tracker::WheelCommandKind::kRimSpeeds, tracker::WheelCommandKind::kBodyRates}) {
    DriveSettings settings = repeating();
    settings.output = output;
    Rehearsal rehearsal(settings, standard_trajectory("circle"), 1);
    rehearsal.run(2.0);
    const Quality quality = quality_of(rehearsal.run(10.0));
    EXPECT_LT(quality.position_rms_m, 0.002);
    EXPECT_LT(quality.tracking_rms_m, 0.006);
  }
}

TEST(DriveCore, ComesFromWhereverItStands) {
  Rehearsal rehearsal(repeating(), standard_trajectory("circle"), 1,
                      Eigen::Vector3d(-0.6, -0.5, 2.5));
  const auto rows = rehearsal.run(12.0);
  EXPECT_EQ(rows.back().phase, MotionPlan::Phase::kFollow);
  EXPECT_LT(quality_of(rows).tracking_rms_m, 0.004);
  EXPECT_FALSE(was(rows, ClientMode::kStopped, ClientReason::kOffTrack));
}

TEST(DriveCore, ASecondWithoutAnyPoseSlowsItDownOnly) {
  Rehearsal rehearsal = on("circle");
  rehearsal.run(8.0);
  rehearsal.tracker_is_up = false;
  const auto dark = rehearsal.run(1.0);
  rehearsal.tracker_is_up = true;
  const auto light = rehearsal.run(3.0);
  EXPECT_TRUE(was(dark, ClientMode::kSlow, ClientReason::kPoseTooOld));
  EXPECT_FALSE(was(light, ClientMode::kStopped, ClientReason::kPoseTooOld));
  EXPECT_TRUE(drives_at_the_end(light));
  EXPECT_LT(quality_of(dark).position_rms_m, 0.03);
}

TEST(DriveCore, WithoutATrackerItStandsUntilOneIsThereAgain) {
  Rehearsal rehearsal = on("circle");
  rehearsal.run(8.0);
  rehearsal.tracker_is_up = false;
  rehearsal.run(2.5);
  const auto standing = rehearsal.run(1.0);
  EXPECT_EQ(standing.back().verdict.reason, ClientReason::kPoseTooOld);
  EXPECT_LT(way_m(standing), 1e-4);
  // Another run of the tracker, on a machine with another clock.
  rehearsal.tracker_is_up = true;
  rehearsal.tracker_epoch = 78;
  rehearsal.vision.clock_ahead_ns = -9'000'000'000;
  const auto rows = rehearsal.run(6.0);
  EXPECT_TRUE(drives_at_the_end(rows));
  EXPECT_EQ(rows.back().phase, MotionPlan::Phase::kFollow);
  EXPECT_NEAR(rows.front().trajectory_s, standing.back().trajectory_s, 1e-9) << "time had paused";
  EXPECT_LT(quality_of(rehearsal.run(5.0)).position_rms_m, 0.002);
}

TEST(DriveCore, EmergencyStopsHoldItUntilTheyAreReleased) {
  Rehearsal rehearsal = on("circle");
  rehearsal.run(5.0);
  tracker::WireEmergencyStop stop;
  rehearsal.core().apply(stop);
  const auto braking = rehearsal.run(0.6);
  EXPECT_EQ(braking.front().verdict.mode, ClientMode::kEmergency);
  EXPECT_LT(way_m(braking), 0.08) << "the motors brake without voltage";
  EXPECT_LT(way_m(rehearsal.run(2.0)), 0.005);
  stop.engaged = false;
  rehearsal.core().apply(stop);
  EXPECT_TRUE(drives_at_the_end(rehearsal.run(1.0)));
  EXPECT_LT(quality_of(rehearsal.run(5.0)).tracking_rms_m, 0.004);
}

TEST(DriveCore, BlindWithoutOdometryItSwitchesTheMotorsOff) {
  Rehearsal rehearsal = on("circle");
  rehearsal.run(5.0);
  rehearsal.odometry_is_up = false;
  const auto rows = rehearsal.run(1.5);
  EXPECT_TRUE(was(rows, ClientMode::kStopped, ClientReason::kNoOdometry));
  EXPECT_LT(rehearsal.base().plant().body_rates().norm(), 1e-3);
  rehearsal.odometry_is_up = true;
  EXPECT_TRUE(drives_at_the_end(rehearsal.run(3.0)));
  EXPECT_LT(quality_of(rehearsal.run(5.0)).position_rms_m, 0.002);
}

TEST(DriveCore, CarriedAwayItStopsAndDrivesBack) {
  Rehearsal rehearsal = on("circle");
  rehearsal.run(5.0);
  rehearsal.base().displace({0.5, -0.3, 1.5});
  const auto rows = rehearsal.run(8.0);
  EXPECT_TRUE(was(rows, ClientMode::kStopped, ClientReason::kOffTrack));
  EXPECT_TRUE(drives_at_the_end(rows));
  EXPECT_EQ(rows.back().phase, MotionPlan::Phase::kFollow);
  EXPECT_LT(quality_of(rehearsal.run(5.0)).tracking_rms_m, 0.004);
}

TEST(DriveCore, TheBaseStopsItselfWhenTheProcessSleeps) {
  Rehearsal rehearsal = on("circle");
  rehearsal.run(5.0);
  rehearsal.sleep_steps = 60;  // 0.3 s
  const auto rows = rehearsal.run(3.0);
  EXPECT_TRUE(was(rows, ClientMode::kStopped, ClientReason::kOther));
  EXPECT_TRUE(drives_at_the_end(rows));
  EXPECT_EQ(rehearsal.core().state().counts.ticks_missed, 15U);
  EXPECT_FALSE(rehearsal.base().stopped_itself());
  EXPECT_LT(quality_of(rehearsal.run(3.0)).position_rms_m, 0.002);
}

TEST(DriveCore, AMissedTickDoesNotDisturbIt) {
  Rehearsal rehearsal = on("circle");
  rehearsal.run(5.0);
  std::vector<RehearsalRow> rows;
  for (int i = 0; i < 20; ++i) {
    rehearsal.sleep_steps = 7;
    const auto more = rehearsal.run(0.5);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  EXPECT_GE(rehearsal.core().state().counts.ticks_missed, 10U);
  const Quality quality = quality_of(rows);
  EXPECT_LT(quality.position_rms_m, 0.002);
  EXPECT_LT(quality.tracking_rms_m, 0.006);
}

TEST(DriveCore, ATrackersClockThatIsSetStopsItUntilTheNewTimeIsKnown) {
  Rehearsal rehearsal = on("circle");
  rehearsal.run(10.0);
  rehearsal.tracker_clock_jump_ns = 2'000'000'000;
  const auto rows = rehearsal.run(4.0);
  EXPECT_TRUE(was(rows, ClientMode::kStopped, ClientReason::kClockJump));
  EXPECT_TRUE(drives_at_the_end(rows));
  EXPECT_LT(quality_of(rehearsal.run(5.0)).position_rms_m, 0.002);
}

/// Where a core believes to be, and how surely, at ticks of 20 ms that get odometry every 5 ms;
/// each pose, captured 5 ms after a tick, comes so many steps later.
std::vector<fusion::Estimate> estimates_with_poses_after(int steps) {
  using fusion::Timestamp;
  const RobotModel model{RobotParameters{}};
  DriveCore core(model, repeating(), standard_trajectory("circle"));
  RandomStream random(7, RandomPurpose::kVision);
  std::vector<fusion::Estimate> estimates;
  Timestamp now = std::chrono::seconds(1000);
  core.add_clock({.epoch = 1,
                  .t1_ns = now.count(),
                  .t2_ns = now.count(),
                  .t3_ns = now.count(),
                  .t4_ns = now.count()});
  std::optional<std::pair<int, tracker::WirePose>> coming;
  for (int i = 0; i < 200; ++i) {
    const Timestamp before = now;
    now += std::chrono::milliseconds(5);
    core.add_odometry({before, now, {0.01 * random.normal(), 0.0, 0.0}});
    if (i % 4 == 1) {
      tracker::WirePose pose;
      pose.camera = "cam0";
      pose.epoch = 1;
      pose.frame = static_cast<std::uint64_t>(i);
      pose.capture_ns = now.count();
      pose.robot.covariance = Eigen::Vector3d(1e-7, 1e-7, 1e-5).asDiagonal();
      coming.emplace(i + steps, pose);
    }
    if (coming && coming->first == i) core.add_pose(coming->second);
    core.step(now, 1);
    if (core.has_ticked() && core.estimate()) estimates.push_back(*core.estimate());
  }
  return estimates;
}

TEST(DriveCore, WhenBetweenTwoTicksAPoseComesMakesNoDifference) {
  const auto at_the_tick = estimates_with_poses_after(3);
  ASSERT_GT(at_the_tick.size(), 40U);
  for (const int steps : {0, 1, 2}) {
    const auto earlier = estimates_with_poses_after(steps);
    ASSERT_EQ(earlier.size(), at_the_tick.size());
    EXPECT_EQ(fusion::pose_difference(earlier.back().pose, at_the_tick.back().pose).norm(), 0.0)
        << steps;
    EXPECT_EQ(earlier.back().covariance, at_the_tick.back().covariance) << steps;
  }
}

TEST(DriveCore, TellsItsState) {
  Rehearsal rehearsal = on("circle");
  const auto rows = rehearsal.run(10.0);
  const tracker::WireClientState state = rehearsal.core().state();
  EXPECT_EQ(state.mode, ClientMode::kDriving);
  EXPECT_NEAR(static_cast<double>(state.clock_offset_ns), 3.7e9, 2e5);
  EXPECT_GT(state.counts.poses_accepted, 350U);
  EXPECT_GT(state.counts.poses_lost, 20U);
  EXPECT_EQ(state.counts.ticks, rows.size());
  EXPECT_EQ(state.counts.odometry_samples, 2000U);
  EXPECT_GT(state.pose_age_ns, 55'000'000);
  EXPECT_LT(state.pose_age_ns, 300'000'000);
  const Eigen::Vector3d error =
      fusion::pose_difference(state.estimate_world_robot, state.nominal_world_robot);
  EXPECT_NEAR(std::hypot(state.error_ahead_m, state.error_left_m), error.head<2>().norm(), 1e-12);
  EXPECT_EQ(state.text, "");
}

}  // namespace
}  // namespace nadir::control_client
