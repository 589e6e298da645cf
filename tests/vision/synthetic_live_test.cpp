// The synthetic camera as a camera in real time: robots from outside, late and lost frames.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/vision/synthetic_test_scenes.h"
#include "vision/synthetic/delivery.h"
#include "vision/synthetic/synthetic_source.h"

namespace nadir::vision {
namespace {

/// Robots that stand where the test puts them, and what was asked of them.
class ScriptedRobots : public LiveRobots {
 public:
  explicit ScriptedRobots(std::vector<LiveRobot> robots) : robots_(std::move(robots)) {}
  void at(CaptureTime time, std::vector<LiveRobot>& robots) override {
    asked.push_back(time);
    robots = robots_;
  }
  void cannot_show(const LiveRobot& robot) override { refused.push_back(robot); }
  void clear() { robots_.clear(); }

  std::vector<CaptureTime> asked;
  std::vector<LiveRobot> refused;

 private:
  std::vector<LiveRobot> robots_;
};

Scene live_scene() {
  Scene scene = plain_scene(lone_disc_layout(0.03));
  scene.rate_hz = 500.0;
  scene.live_robots = SceneLiveRobots{.layouts = {0}, .hold_s = 0.5};
  return scene;
}

LiveRobot robot_at(double x_m, double y_m, const std::string& team = "only") {
  LiveRobot robot{.team = team, .id = 4, .motion = {}};
  robot.motion.x_m = x_m;
  robot.motion.y_m = y_m;
  return robot;
}

TEST(LiveScene, ShowsRobotsWhereTheyAreAndNoLongerWhenTheyAreGone) {
  auto robots = std::make_shared<ScriptedRobots>(std::vector{robot_at(0.2, -0.1)});
  SyntheticSource source(live_scene(), 3, robots);
  EXPECT_TRUE(source.is_live());
  Frame frame;
  ASSERT_EQ(source.read(frame).status, ReadStatus::kFrame);
  ASSERT_EQ(robots->asked.size(), 1U);
  EXPECT_EQ(robots->asked[0], frame.capture_time);
  cv::Mat expected;
  const RobotPlacement placement{0, 0, 4, robot_at(0.2, -0.1).motion};
  Renderer(live_scene(), 3).render_robots(frame.number, std::vector{placement}, expected);
  EXPECT_EQ(cv::norm(frame.image, expected, cv::NORM_INF), 0.0);

  robots->clear();
  ASSERT_EQ(source.read(frame).status, ReadStatus::kFrame);
  Renderer(live_scene(), 3).render(frame.number, expected);
  EXPECT_EQ(cv::norm(frame.image, expected, cv::NORM_INF), 0.0);
}

TEST(LiveScene, TellsOfRobotsThatItHasNoLayoutFor) {
  auto robots = std::make_shared<ScriptedRobots>(
      std::vector{robot_at(0.0, 0.0, "other"), robot_at(0.1, 0.1)});
  SyntheticSource source(live_scene(), 3, robots);
  Frame frame;
  ASSERT_EQ(source.read(frame).status, ReadStatus::kFrame);
  ASSERT_EQ(robots->refused.size(), 1U);
  EXPECT_EQ(robots->refused[0].team, "other");
}

TEST(LiveScene, DelayedFramesComeInOrderNeverBeforeTheirTimeAndWithTheirTrueCaptureTime) {
  Scene scene = live_scene();
  scene.rate_hz = 200.0;
  scene.delivery.shortest_delay_s = 0.02;
  scene.delivery.longest_delay_s = 0.05;
  SyntheticSource source(scene, 3, std::make_shared<ScriptedRobots>(std::vector<LiveRobot>{}));
  const Delivery delivery(scene.delivery, scene.rate_hz, 3);
  Frame frame;
  std::optional<Frame> first;
  std::uint64_t before = 0;
  for (int i = 0; i < 30; ++i) {
    ASSERT_EQ(source.read(frame).status, ReadStatus::kFrame);
    const auto age = std::chrono::system_clock::now() - frame.capture_time;
    EXPECT_GE(std::chrono::duration<double>(age).count(),
              delivery.delay_s(frame.number).value() - 1e-3);
    if (first) {
      EXPECT_GT(frame.number, before);
      // Capture times are on the raster of the camera's rate, however late a frame comes.
      EXPECT_EQ((frame.capture_time - first->capture_time).count(),
                static_cast<std::int64_t>(frame.number - first->number) * 5'000'000);
    } else {
      first = Frame{frame.number, frame.capture_time, {}};
    }
    before = frame.number;
  }
}

TEST(LiveScene, LostFramesLeaveGapsAndABlackoutIsTold) {
  Scene scene = live_scene();
  scene.rate_hz = 100.0;
  scene.delivery.loss = 0.3;
  scene.delivery.blackouts = {{.start_s = 0.05, .length_s = 0.5}};
  const Delivery delivery(scene.delivery, scene.rate_hz, 3);
  SyntheticSource source(scene, 3, std::make_shared<ScriptedRobots>(std::vector<LiveRobot>{}));
  Frame frame;
  int unavailable = 0;
  do {
    const ReadResult result = source.read(frame);
    if (result.status == ReadStatus::kUnavailable) {
      ++unavailable;
      EXPECT_NE(result.message.find("interrupted"), std::string::npos);
    } else {
      ASSERT_EQ(result.status, ReadStatus::kFrame);
      EXPECT_TRUE(delivery.delay_s(frame.number).has_value()) << frame.number;
    }
  } while (frame.number < 60);
  EXPECT_GE(unavailable, 1);
}

TEST(Delivery, LosesAndDelaysAsManyAsItSaysAndTheSameForASeed) {
  SceneDelivery wish;
  wish.shortest_delay_s = 0.06;
  wish.longest_delay_s = 0.10;
  wish.loss = 0.1;
  const Delivery delivery(wish, 50.0, 7);
  const Delivery again(wish, 50.0, 7);
  const Delivery other(wish, 50.0, 8);
  constexpr int kFrames = 20000;
  int lost = 0;
  int same = 0;
  double sum_s = 0.0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const auto delay_s = delivery.delay_s(frame);
    ASSERT_EQ(delay_s, again.delay_s(frame));
    if (delay_s == other.delay_s(frame)) ++same;
    if (!delay_s) {
      ++lost;
      continue;
    }
    ASSERT_GE(*delay_s, 0.06);
    ASSERT_LE(*delay_s, 0.10);
    sum_s += *delay_s;
  }
  // Binomial: 4.5 sigma; the mean of a uniform number: 4.5 sigma.
  EXPECT_NEAR(lost, 0.1 * kFrames, 4.5 * std::sqrt(0.09 * kFrames));
  EXPECT_NEAR(sum_s / (kFrames - lost), 0.08, 4.5 * 0.04 / std::sqrt(12.0 * 0.9 * kFrames));
  EXPECT_LT(same, 0.02 * kFrames);  // both lost, 1 %
}

TEST(Delivery, NothingArrivesInABlackout) {
  SceneDelivery wish;
  wish.blackouts = {{.start_s = 1.0, .length_s = 0.5}, {.start_s = 3.0, .length_s = 0.1}};
  const Delivery delivery(wish, 10.0, 1);
  for (int frame = 0; frame < 50; ++frame) {
    const bool dark = (frame >= 10 && frame < 15) || frame == 30;
    EXPECT_EQ(delivery.delay_s(frame).has_value(), !dark) << frame;
    EXPECT_EQ(delivery.is_blacked_out(frame), dark) << frame;
  }
}

}  // namespace
}  // namespace nadir::vision
