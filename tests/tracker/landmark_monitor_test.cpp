#include "tracker/landmark_monitor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace nadir::tracker {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kSigma_m = 0.001;

/// A camera that sees one robot with noise of 1 mm, as it publishes.
class SeenRobot {
 public:
  explicit SeenRobot(int id = 7) {
    RobotReport robot;
    robot.id = id;
    robot.team = "blue";
    robot.covariance = kSigma_m * kSigma_m * fusion::PoseCovariance::Identity();
    report_.camera = "north";
    report_.robots = {robot};
  }

  const FrameReport& at(double x_m, double y_m) {
    std::normal_distribution<double> noise(0.0, kSigma_m);
    report_.robots.front().pose_world_robot = {x_m + noise(random_), y_m + noise(random_), 0.3};
    ++report_.frame;
    return report_;
  }
  const FrameReport& hidden() {
    report_.robots.clear();
    return report_;
  }

 private:
  FrameReport report_;
  std::mt19937_64 random_{5};
};

/// All lines of `frames` frames.
std::vector<std::string> watch(LandmarkMonitor& monitor, SeenRobot& robot, double x_m, double y_m,
                               int frames) {
  std::vector<std::string> lines;
  for (int i = 0; i < frames; ++i) {
    for (std::string& line : monitor.update(robot.at(x_m, y_m))) lines.push_back(std::move(line));
  }
  return lines;
}

TEST(LandmarkMonitor, IsSilentWhileNothingHappens) {
  LandmarkMonitor monitor({{"north", "blue", 7, {1.0, -0.5}}});
  SeenRobot robot;
  EXPECT_THAT(watch(monitor, robot, 1.002, -0.501, 3000), IsEmpty());
}

TEST(LandmarkMonitor, TellsOfAKnockOnceAndOfItsEnd) {
  LandmarkMonitor monitor({{"north", "blue", 7, {1.0, -0.5}}});
  SeenRobot robot;
  ASSERT_THAT(watch(monitor, robot, 1.0, -0.5, 50), IsEmpty());
  const auto knocked = watch(monitor, robot, 1.010, -0.512, 200);
  ASSERT_EQ(knocked.size(), 1U);
  EXPECT_THAT(knocked[0], HasSubstr("north: landmark blue 7 seems to have moved by +"));
  EXPECT_THAT(knocked[0], HasSubstr("was the camera knocked?"));
  const auto back = watch(monitor, robot, 1.0, -0.5, 200);
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0], "north: landmark blue 7 is at its place again");
}

TEST(LandmarkMonitor, TellsWhenALandmarkIsGone) {
  LandmarkMonitor monitor({{"north", "blue", 7, {1.0, -0.5}}});
  SeenRobot robot;
  ASSERT_THAT(watch(monitor, robot, 1.0, -0.5, 50), IsEmpty());
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < 2 * LandmarkMonitor::kUnseenFrames; ++i) {
    for (std::string& line : monitor.update(robot.hidden())) lines.push_back(std::move(line));
  }
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_THAT(lines[0], HasSubstr("landmark blue 7 is not seen within 0.25 m of its place"));
}

TEST(LandmarkMonitor, LooksAtTheRightCameraTeamAndNumber) {
  LandmarkMonitor monitor({{"south", "blue", 7, {1.0, -0.5}},
                           {"north", "yellow", 7, {1.0, -0.5}},
                           {"north", "blue", 3, {1.0, -0.5}}});
  SeenRobot robot;
  for (const std::string& line : watch(monitor, robot, 1.1, -0.5, 250)) {
    EXPECT_THAT(line, testing::Not(HasSubstr("moved")));
  }
  // Anonymous robots have no number: the nearest of the team counts.
  LandmarkMonitor anonymous({{"north", "blue", -1, {1.0, -0.5}}});
  EXPECT_EQ(watch(anonymous, robot, 1.1, -0.5, 60).size(), 1U);
}

}  // namespace
}  // namespace nadir::tracker
