#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/test_poses.h"
#include "tracker/wire/pose_codec.h"

namespace nadir::tracker {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool encodes(const WirePose& pose) {
  nadir_wire_RobotPose sample{};
  return encode(pose, &sample);
}

TEST(PoseCodec, RoundTripKeepsEveryFieldToTheLastBit) {
  WirePose decoded;  // reused: what an earlier pose left behind must not show
  for (int i = 0; i < 2000; ++i) {
    const WirePose pose = test::test_pose(17, static_cast<std::uint64_t>(i / 12), i % 12);
    nadir_wire_RobotPose sample{};
    ASSERT_TRUE(encode(pose, &sample));
    sample.publish_ns = 1234 + i;
    ASSERT_TRUE(decode(sample, &decoded));
    ASSERT_EQ(test::difference(pose, decoded), "");
    ASSERT_EQ(decoded.publish_ns, 1234 + i);
  }
}

TEST(PoseCodec, TestPosesTellFieldsApart) {
  // The oracle of the tests below: a field that is mixed up or lost must make a difference.
  const WirePose pose = test::test_pose(1, 2, 3);
  const std::vector<std::pair<std::string, std::function<void(WirePose*)>>> changes = {
      {" camera", [](WirePose* p) { p->camera += "x"; }},
      {" epoch", [](WirePose* p) { ++p->epoch; }},
      {" frame", [](WirePose* p) { ++p->frame; }},
      {" capture_ns", [](WirePose* p) { ++p->capture_ns; }},
      {" team", [](WirePose* p) { p->robot.team += "x"; }},
      {" robot", [](WirePose* p) { ++p->robot.robot; }},
      {" covariance", [](WirePose* p) { p->robot.covariance(1, 2) *= 1.5; }},
      {" pixels", [](WirePose* p) { ++p->robot.pixels[1]; }}};
  for (const auto& [name, change] : changes) {
    WirePose changed = pose;
    change(&changed);
    EXPECT_EQ(test::difference(pose, changed), name);
  }
  EXPECT_NE(pose.robot.covariance(0, 1), pose.robot.covariance(0, 2));
}

TEST(PoseCodec, RowsAndColumnsOfTheCovarianceStayApart) {
  WirePose pose = test::test_pose(1, 1, 1);
  pose.robot.covariance(0, 2) = 0.125;  // not symmetric on purpose
  nadir_wire_RobotPose sample{};
  ASSERT_TRUE(encode(pose, &sample));
  EXPECT_EQ(sample.estimate.covariance[2], 0.125);
  EXPECT_NE(sample.estimate.covariance[6], 0.125);
}

TEST(PoseCodec, BoundsAreThoseOfTheTypes) {
  WirePose pose = test::test_pose(1, 1, 1);
  pose.robot.team = std::string(kMaxTeamLength, 't');
  pose.camera = std::string(kMaxCameraLength, 'c');
  pose.robot.marker_count = kMaxWireMarkers;
  pose.robot.pose_world_robot.heading_rad = std::numbers::pi;
  nadir_wire_RobotPose sample{};
  ASSERT_TRUE(encode(pose, &sample));
  WirePose decoded;
  ASSERT_TRUE(decode(sample, &decoded));
  EXPECT_EQ(test::difference(pose, decoded), "");
}

TEST(PoseCodec, RefusesWhatDoesNotBelongOnTheWire) {
  const std::vector<std::function<void(WirePose*)>> spoil = {
      [](WirePose* p) { p->robot.team = std::string(kMaxTeamLength + 1, 't'); },
      [](WirePose* p) { p->camera = std::string(kMaxCameraLength + 1, 'c'); },
      [](WirePose* p) { p->camera = std::string("a\0b", 3); },
      [](WirePose* p) { p->robot.marker_count = kMaxWireMarkers + 1; },
      [](WirePose* p) { p->robot.pose_world_robot.x_m = kNan; },
      [](WirePose* p) { p->robot.pose_world_robot.y_m = kInfinity; },
      [](WirePose* p) { p->robot.pose_world_robot.heading_rad = kNan; },
      [](WirePose* p) { p->robot.pose_world_robot.heading_rad = -std::numbers::pi; },
      [](WirePose* p) { p->robot.pose_world_robot.heading_rad = 3.2; },
      [](WirePose* p) { p->robot.covariance(1, 0) = kNan; },
      [](WirePose* p) { p->robot.covariance(2, 2) = -1e-9; },
      [](WirePose* p) { p->robot.u_px = kNan; },
      [](WirePose* p) { p->robot.confidence = 1.01; },
      [](WirePose* p) { p->robot.confidence = kNan; }};
  for (std::size_t i = 0; i < spoil.size(); ++i) {
    WirePose pose = test::test_pose(1, 1, 1);
    ASSERT_TRUE(encodes(pose));
    spoil[i](&pose);
    EXPECT_FALSE(encodes(pose)) << "case " << i;
  }
}

TEST(PoseCodec, RefusesImpossibleSamplesFromTheNetwork) {
  const WirePose pose = test::test_pose(1, 1, 1);
  nadir_wire_RobotPose sample{};
  ASSERT_TRUE(encode(pose, &sample));
  WirePose decoded;
  nadir_wire_RobotPose spoilt = sample;
  spoilt.estimate.covariance[4] = kNan;
  EXPECT_FALSE(decode(spoilt, &decoded));
  spoilt = sample;
  spoilt.estimate.heading_rad = 7.0;
  EXPECT_FALSE(decode(spoilt, &decoded));
  spoilt = sample;
  spoilt.estimate.pixels._length = kMaxWireMarkers + 1;
  EXPECT_FALSE(decode(spoilt, &decoded));
}

TEST(FrameCodec, RoundTripFromEmptyToTheFullFrame) {
  std::vector<nadir_wire_FrameRobot> storage;
  WireFrame decoded;
  for (const int robots : {0, 1, 12, static_cast<int>(kMaxRobotsInFrame), 3, 0}) {
    const WireFrame frame = test::test_frame(5, 40 + static_cast<std::uint64_t>(robots), robots);
    nadir_wire_FrameSummary sample{};
    ASSERT_TRUE(encode(frame, &storage, &sample));
    ASSERT_TRUE(decode(sample, &decoded));
    EXPECT_EQ(test::difference(frame, decoded), "") << robots << " robots";
  }
}

TEST(FrameCodec, RefusesMoreRobotsThanTheTypeHolds) {
  std::vector<nadir_wire_FrameRobot> storage;
  nadir_wire_FrameSummary sample{};
  const WireFrame frame = test::test_frame(1, 1, static_cast<int>(kMaxRobotsInFrame) + 1);
  EXPECT_FALSE(encode(frame, &storage, &sample));
}

}  // namespace
}  // namespace nadir::tracker
