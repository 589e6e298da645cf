// nadir-tracker with the live synthetic camera: this process is the simulated robot and its client.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/support/loopback_dds.h"
#include "tracker/wire/clock_exchange.h"
#include "tracker/wire/pose_reader.h"
#include "tracker/wire/value_streams.h"

namespace nadir::tracker {
namespace {

using namespace std::chrono_literals;
using test::ChildProcess;
namespace fs = std::filesystem;

const fs::path kData = NADIR_DATA_DIR;
const fs::path kTracker = fs::path(NADIR_BIN_DIR) / "nadir-tracker";

constexpr std::chrono::seconds kPatience{60};

/// A robot on a circle of 0.4 m, once round in 4 s; its place is a function of the wall clock.
WireSimulatedTruth on_circle(std::int64_t time_ns, std::int32_t robot) {
  constexpr double kRate_radps = 2.0 * 3.14159265358979323846 / 4.0;
  const double angle = kRate_radps * 1e-9 * static_cast<double>(time_ns % 4'000'000'000) + robot;
  WireSimulatedTruth truth;
  truth.team = "blue";
  truth.robot = robot;
  truth.epoch = 1;
  truth.time_ns = time_ns;
  truth.pose_world_robot = {0.4 * std::cos(angle), 0.4 * std::sin(angle),
                            fusion::wrap_angle(angle + 1.0)};
  truth.velocity_x_mps = -0.4 * kRate_radps * std::sin(angle);
  truth.velocity_y_mps = 0.4 * kRate_radps * std::cos(angle);
  truth.heading_rate_radps = kRate_radps;
  return truth;
}

/// Publishes the truth of some robots until it goes.
class Simulation {
 public:
  Simulation(const Participant& participant, std::vector<std::int32_t> robots)
      : writer_(participant), thread_([this, robots](const std::stop_token& stop) {
          while (!stop.stop_requested()) {
            for (const std::int32_t robot : robots) {
              writer_.write(on_circle(system_clock_ns(), robot));
            }
            std::this_thread::sleep_for(5ms);
          }
        }) {}

 private:
  SimulatedTruthWriter writer_;
  std::jthread thread_;
};

class LiveTracker : public testing::Test {
 protected:
  ChildProcess tracker() const {
    return {kTracker,
            {"--source", "synthetic:" + (kData / "scenes/live_league.yaml").string(), "--layout",
             (kData / "layouts/league.yaml").string(), "--calibration",
             (kData / "calibrations/live_league.yaml").string(), "--domain",
             std::to_string(dds_.domain())},
            dds_.environment()};
  }

  static bool becomes_true(const std::function<bool()>& goal) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < end) {
      if (goal()) return true;
    }
    return false;
  }

  test::LoopbackDds dds_;
  Participant participant_{WireOptions{dds_.domain(), ""}};
};

TEST_F(LiveTracker, SeesSimulatedRobotsWhereTheyWereAtTheCapture) {
  PoseReader reader(participant_, ReaderOptions{});
  const ChildProcess child = tracker();
  const Simulation simulation(participant_, {2, 3});
  WirePose pose;
  int seen[2] = {0, 0};
  while (seen[0] < 20 || seen[1] < 20) {
    ASSERT_TRUE(reader.poll(&pose, kPatience)) << child.err();
    const std::int64_t now_ns = system_clock_ns();
    ASSERT_TRUE(pose.robot.robot == 2 || pose.robot.robot == 3) << pose.robot.robot;
    ASSERT_EQ(pose.robot.team, "blue");
    const WireSimulatedTruth truth = on_circle(pose.capture_ns, pose.robot.robot);
    const Eigen::Vector3d error =
        fusion::pose_difference(pose.robot.pose_world_robot, truth.pose_world_robot);
    EXPECT_LT(error.head<2>().norm(), 0.003) << "frame " << pose.frame;
    EXPECT_LT(std::abs(error[2]), 0.03) << "frame " << pose.frame;
    // The scene's delivery: nothing comes earlier than 60 ms after its capture.
    EXPECT_GE(now_ns - pose.capture_ns, 59'000'000);
    ++seen[pose.robot.robot - 2];
  }
}

TEST_F(LiveTracker, WithoutRobotsItPublishesEmptyFramesAndARobotThatGoesIsNoLongerShown) {
  FrameReader reader(participant_, ReaderOptions{});
  const ChildProcess child = tracker();
  WireFrame frame;
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(reader.poll(&frame, kPatience)) << child.err();
    EXPECT_TRUE(frame.robots.empty());
  }
  {
    const Simulation simulation(participant_, {3});
    EXPECT_TRUE(becomes_true([&] {
      return reader.poll(&frame, kPatience) && frame.robots.size() == 1;
    })) << child.err();
  }
  EXPECT_TRUE(becomes_true([&] { return reader.poll(&frame, kPatience) && frame.robots.empty(); }))
      << child.err();
}

TEST_F(LiveTracker, KilledAndRestartedItIsANewEpochOfTheSameRobots) {
  PoseReader reader(participant_, ReaderOptions{});
  const Simulation simulation(participant_, {5});
  WirePose pose;
  std::uint64_t epoch = 0;
  {
    ChildProcess first = tracker();
    ASSERT_TRUE(reader.poll(&pose, kPatience)) << first.err();
    epoch = pose.epoch;
    first.signal(SIGKILL);
  }
  const ChildProcess second = tracker();
  ASSERT_TRUE(becomes_true([&] { return reader.poll(&pose, kPatience) && pose.epoch != epoch; }))
      << second.err();
  EXPECT_GT(pose.epoch, epoch);
  EXPECT_EQ(pose.robot.robot, 5);
}

TEST_F(LiveTracker, TellsItsClockUnderTheEpochOfItsPoses) {
  PoseReader reader(participant_, ReaderOptions{});
  const ChildProcess child = tracker();
  const Simulation simulation(participant_, {1});
  constexpr std::int64_t kError_ns = 3'500'000'000;
  ClockAsker asker(participant_, 1, [] { return system_clock_ns() + kError_ns; });
  ClockExchange exchange;
  ASSERT_TRUE(becomes_true([&] {
    asker.ask();
    return asker.poll(&exchange, 20ms);
  })) << child.err();
  EXPECT_LE(std::abs(exchange.offset_ns() + kError_ns), exchange.round_trip_ns() / 2 + 1);
  WirePose pose;
  ASSERT_TRUE(reader.poll(&pose, kPatience)) << child.err();
  EXPECT_EQ(pose.epoch, exchange.epoch);
}

TEST_F(LiveTracker, SaysWhichRobotItCannotShow) {
  ChildProcess child = tracker();
  const Simulation simulation(participant_, {99});
  EXPECT_TRUE(child.wait_for_err("simulated robot 'blue' 99 is in none of the layouts", kPatience))
      << child.err();
  child.signal(SIGTERM);
  EXPECT_EQ(child.wait(kPatience), 0) << child.err();
}

}  // namespace
}  // namespace nadir::tracker
