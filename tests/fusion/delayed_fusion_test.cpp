#include "fusion/delayed_fusion.h"

#include <gtest/gtest.h>

#include <array>

namespace nadir::fusion {
namespace {

using namespace std::chrono_literals;

constexpr Timestamp kStart = 100s;
const PoseCovariance kCovariance = Eigen::Vector3d(1e-6, 1e-6, 1e-4).asDiagonal();

VisionPose pose_at(Timestamp capture, const PlanarPose& pose, std::uint64_t frame,
                   std::uint32_t camera = 0) {
  return {camera, 0, frame, capture, pose, kCovariance};
}

/// Odometry of 10 ms each up to this time, driving along x at 1 m/s.
void drive_until(DelayedFusion<>& fusion, Timestamp until) {
  for (Timestamp t = fusion.now().count() == 0 ? kStart : fusion.now(); t < until; t += 10ms) {
    EXPECT_EQ(fusion.add_odometry({t, t + 10ms, {1.0, 0.0, 0.0}, {}}), OdometryVerdict::kUsed);
  }
}

TEST(DelayedFusion, HasNoEstimateBeforeItKnowsWhereItIs) {
  DelayedFusion<> fusion;
  EXPECT_FALSE(fusion.estimate());
  drive_until(fusion, kStart + 100ms);
  EXPECT_FALSE(fusion.estimate());
  EXPECT_FALSE(fusion.health().age_of_last_used);
}

TEST(DelayedFusion, AddsUpOdometryFromAKnownStart) {
  DelayedFusion<> fusion;
  fusion.start(kStart, {0.5, 0.0, 0.0}, kCovariance);
  drive_until(fusion, kStart + 500ms);
  ASSERT_TRUE(fusion.estimate());
  EXPECT_NEAR(fusion.estimate()->pose.x_m, 1.0, 1e-12);
  EXPECT_EQ(fusion.estimate()->rates.u_mps, 1.0);
  EXPECT_GT(fusion.estimate()->covariance(0, 0), kCovariance(0, 0));
}

TEST(DelayedFusion, FirstPoseStartsItWhereItWasCaptured) {
  DelayedFusion<> fusion;
  drive_until(fusion, kStart + 100ms);
  EXPECT_EQ(fusion.add_pose(pose_at(kStart + 35ms, {0.2, 0.3, 0.0}, 1)).verdict,
            PoseVerdict::kStarted);
  EXPECT_NEAR(fusion.estimate()->pose.x_m, 0.265, 1e-12);
  EXPECT_NEAR(fusion.estimate()->pose.y_m, 0.3, 1e-12);
  EXPECT_EQ(fusion.health().age_of_last_used, 65ms);
  EXPECT_FALSE(fusion.estimate_at(kStart + 34ms));
  EXPECT_NEAR(fusion.estimate_at(kStart + 40ms)->pose.x_m, 0.205, 1e-12);
}

TEST(DelayedFusion, AnEarlierPoseThatComesLaterStartsItInstead) {
  DelayedFusion<> fusion;
  drive_until(fusion, kStart + 100ms);
  fusion.add_pose(pose_at(kStart + 60ms, {0.06, 0.0, 0.0}, 2));
  EXPECT_EQ(fusion.add_pose(pose_at(kStart + 20ms, {0.02, 0.0, 0.0}, 1)).verdict,
            PoseVerdict::kStarted);
  EXPECT_EQ(fusion.health().count(PoseVerdict::kStarted), 1U);
  EXPECT_EQ(fusion.health().count(PoseVerdict::kAccepted), 1U);
  EXPECT_EQ(fusion.health().revised, 1U);
}

TEST(DelayedFusion, PoseIsUsedAtItsCaptureAndNotAtItsArrival) {
  DelayedFusion<> fusion;
  fusion.start(kStart, {0.0, 0.0, 0.0}, kCovariance);
  drive_until(fusion, kStart + 200ms);
  // Right when captured, 100 mm behind by now.
  EXPECT_EQ(fusion.add_pose(pose_at(kStart + 100ms, {0.1, 0.0, 0.0}, 1)).verdict,
            PoseVerdict::kAccepted);
  EXPECT_NEAR(fusion.estimate()->pose.x_m, 0.2, 1e-6);
}

TEST(DelayedFusion, LooksAheadWithTheLastRatesAndBackIntoItsHistory) {
  DelayedFusion<> fusion;
  fusion.start(kStart, {0.0, 0.0, 0.0}, kCovariance);
  drive_until(fusion, kStart + 200ms);
  EXPECT_NEAR(fusion.estimate_at(kStart + 250ms)->pose.x_m, 0.25, 1e-12);
  EXPECT_GT(fusion.estimate_at(kStart + 250ms)->covariance(0, 0),
            fusion.estimate()->covariance(0, 0));
  EXPECT_NEAR(fusion.estimate_at(kStart + 123ms)->pose.x_m, 0.123, 1e-12);
  EXPECT_EQ(fusion.estimate_at(kStart)->pose.x_m, 0.0);
  EXPECT_FALSE(fusion.estimate_at(kStart - 1ms));
}

TEST(DelayedFusion, PoseALittleAheadOfOdometryWaitsForIt) {
  DelayedFusion<> fusion;
  fusion.start(kStart, {0.0, 0.0, 0.0}, kCovariance);
  drive_until(fusion, kStart + 50ms);
  EXPECT_EQ(fusion.add_pose(pose_at(kStart + 55ms, {0.055, 0.0, 0.0}, 1)).verdict,
            PoseVerdict::kWaitsForOdometry);
  EXPECT_EQ(fusion.health().count(PoseVerdict::kWaitsForOdometry), 1U);
  drive_until(fusion, kStart + 60ms);
  EXPECT_EQ(fusion.health().count(PoseVerdict::kWaitsForOdometry), 0U);
  EXPECT_EQ(fusion.health().count(PoseVerdict::kAccepted), 1U);
  EXPECT_EQ(fusion.health().age_of_last_used, 5ms);
}

TEST(DelayedFusion, PosesOfOneTickAreUsedInTheOrderOfTheCameras) {
  DelayedFusion<> fusion;
  DelayedFusion<> other;
  for (DelayedFusion<>* each : {&fusion, &other}) {
    each->start(kStart, {0.0, 0.0, 0.0}, kCovariance);
    drive_until(*each, kStart + 100ms);
  }
  const VisionPose first = pose_at(kStart + 50ms, {0.052, 0.0, 0.0}, 1, 0);
  const VisionPose second = pose_at(kStart + 50ms, {0.048, 0.001, 0.0}, 1, 1);
  EXPECT_EQ(fusion.add_pose(first).verdict, PoseVerdict::kAccepted);
  EXPECT_EQ(fusion.add_pose(second).verdict, PoseVerdict::kAccepted);
  const std::array<VisionPose, 2> both = {second, first};
  std::array<Correction, 2> results;
  other.add_poses(both, results);
  EXPECT_EQ(results[0].verdict, PoseVerdict::kAccepted);
  EXPECT_EQ(fusion.estimate()->pose.x_m, other.estimate()->pose.x_m);
  EXPECT_EQ(fusion.estimate()->covariance, other.estimate()->covariance);
  EXPECT_EQ(other.frames()[0].vision_pose().camera, 0U);
}

TEST(DelayedFusion, ForgetsWholeBlocksWhenItIsFull) {
  DelayedFusion<>::Settings settings;
  settings.history = {10, 3, 50};
  DelayedFusion<> fusion(settings);
  fusion.start(kStart, {0.0, 0.0, 0.0}, kCovariance);
  drive_until(fusion, kStart + 300ms);
  EXPECT_EQ(fusion.horizon(), kStart);
  drive_until(fusion, kStart + 310ms);
  EXPECT_EQ(fusion.horizon(), kStart + 100ms);
  EXPECT_EQ(fusion.add_pose(pose_at(kStart + 100ms, {0.1, 0.0, 0.0}, 1)).verdict,
            PoseVerdict::kTooOld);
  EXPECT_EQ(fusion.add_pose(pose_at(kStart + 101ms, {0.101, 0.0, 0.0}, 2)).verdict,
            PoseVerdict::kAccepted);
}

TEST(DelayedFusion, WithoutRoomForPosesItForgetsEarlierOnesFirst) {
  DelayedFusion<>::Settings settings;
  settings.history = {10, 4, 5};
  DelayedFusion<> fusion(settings);
  fusion.start(kStart, {0.0, 0.0, 0.0}, kCovariance);
  drive_until(fusion, kStart + 395ms);
  std::array<VisionPose, 12> poses;
  std::array<Correction, 12> results;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto after = std::chrono::milliseconds(30 * (i + 1));
    poses.at(i) = pose_at(kStart + after, {to_seconds(after), 0.0, 0.0}, i);
  }
  fusion.add_poses(poses, results);
  for (const Correction& result : results) EXPECT_EQ(result.verdict, PoseVerdict::kAccepted);
  EXPECT_LE(fusion.frames().size(), 5U);
  EXPECT_EQ(fusion.health().count(PoseVerdict::kAccepted), 12U);
  // All within the newest block: no older ones to forget.
  int no_room = 0;
  for (std::uint64_t i = 0; i < 8; ++i) {
    const auto capture = kStart + 391ms + std::chrono::milliseconds(i);
    no_room += fusion.add_pose(pose_at(capture, {0.391, 0.0, 0.0}, 100 + i)).verdict ==
                       PoseVerdict::kNoRoom
                   ? 1
                   : 0;
  }
  EXPECT_GT(no_room, 0);
  EXPECT_NEAR(fusion.estimate()->pose.x_m, 0.4, 0.01);
}

TEST(DelayedFusion, TellsHowMuchMemoryItHolds) {
  EXPECT_LT(DelayedFusion<>().memory_bytes(), 16000U) << "a second at 200 Hz, 50 poses";
}

TEST(DelayedFusion, ReportsTheNisOfAcceptedPoses) {
  DelayedFusion<> fusion;
  fusion.start(kStart, {0.0, 0.0, 0.0}, kCovariance);
  drive_until(fusion, kStart + 100ms);
  const Correction near = fusion.add_pose(pose_at(kStart + 50ms, {0.051, 0.0, 0.0}, 1));
  fusion.add_pose(pose_at(kStart + 60ms, {1.0, 1.0, 0.0}, 2));
  EXPECT_EQ(fusion.health().nis_poses, 1);
  EXPECT_NEAR(fusion.health().nis_mean, near.nis, 1e-6);
}

}  // namespace
}  // namespace nadir::fusion
