// The small parts around the pipeline: queue, pace, statistics, limits on messages, words of the
// wire.

#include <gtest/gtest.h>

#include <chrono>
#include <stop_token>
#include <thread>

#include "tracker/console.h"
#include "tracker/publisher.h"
#include "tracker/recorded_pace.h"
#include "tracker/report_queue.h"
#include "tracker/run_statistics.h"

namespace nadir::tracker {
namespace {

using namespace std::chrono_literals;

FinishedFrame numbered(std::uint64_t number) {
  FinishedFrame frame;
  frame.report.frame = number;
  return frame;
}

TEST(ReportQueue, DropsTheOldestOfACameraAndCountsIt) {
  ReportQueue queue(2);
  for (std::uint64_t k = 0; k < 5; ++k) {
    FinishedFrame frame = numbered(k);
    queue.push_or_drop(frame);
  }
  EXPECT_EQ(queue.dropped(), 3u);
  FinishedFrame frame;
  ASSERT_TRUE(queue.pop(frame, 0ms));
  EXPECT_EQ(frame.report.frame, 3u);
  ASSERT_TRUE(queue.pop(frame, 0ms));
  EXPECT_EQ(frame.report.frame, 4u);
  EXPECT_FALSE(queue.pop(frame, 0ms));
}

TEST(ReportQueue, LosesNothingOfARecording) {
  ReportQueue queue(2);
  std::jthread camera([&queue](const std::stop_token& stop) {
    for (std::uint64_t k = 0; k < 200; ++k) {
      FinishedFrame frame = numbered(k);
      EXPECT_TRUE(queue.push_or_wait(frame, stop));
    }
  });
  FinishedFrame frame;
  for (std::uint64_t k = 0; k < 200; ++k) {
    ASSERT_TRUE(queue.pop(frame, 10s));
    ASSERT_EQ(frame.report.frame, k);
  }
  EXPECT_EQ(queue.dropped(), 0u);
}

TEST(ReportQueue, AStopEndsTheWaitForRoom) {
  ReportQueue queue(1);
  FinishedFrame first = numbered(0);
  queue.push_or_drop(first);
  bool pushed = true;
  std::jthread camera([&](const std::stop_token& stop) {
    FinishedFrame second = numbered(1);
    pushed = queue.push_or_wait(second, stop);
  });
  camera.request_stop();
  camera.join();
  EXPECT_FALSE(pushed);
}

vision::CaptureTime at(std::chrono::milliseconds time) { return vision::CaptureTime(time); }

TEST(RecordedPace, KeepsTheDistancesOfTheRecording) {
  RecordedPace pace;
  const RecordedPace::Clock::time_point start{100s};
  EXPECT_EQ(pace.due(at(5000ms), start), start);
  EXPECT_EQ(pace.due(at(5040ms), start + 3ms), start + 40ms);
  // A late frame does not shift those after it.
  EXPECT_EQ(pace.due(at(5080ms), start + 300ms), start + 80ms);
}

TEST(RecordedPace, StartsAnewWhereTimesGoBack) {
  RecordedPace pace;
  const RecordedPace::Clock::time_point start{100s};
  pace.due(at(5000ms), start);
  EXPECT_EQ(pace.due(at(10ms), start + 1s), start + 1s);
  EXPECT_EQ(pace.due(at(30ms), start + 1s), start + 1020ms);
}

FrameReport report_with(double total_us, int robots) {
  FrameReport report;
  report.stages = {0.0, 0.0, 0.0, total_us};
  report.robots.resize(static_cast<std::size_t>(robots));
  return report;
}

TEST(RunStatistics, CountsAndTakesMedians) {
  RunStatistics statistics;
  EXPECT_EQ(statistics.median_stages().total_us, 0.0);
  for (const double total_us : {5.0, 1.0, 1000.0, 3.0, 4.0})
    statistics.add(report_with(total_us, 2));
  statistics.add_skipped();
  EXPECT_EQ(statistics.median_stages().total_us, 4.0);
  EXPECT_EQ(statistics.frames(), 5u);
  EXPECT_EQ(statistics.summary("north").substr(0, 44),
            "north: 5 frames, 1 skipped, 2.00 robots and ");
}

TEST(RunStatistics, MediansAreThoseOfTheLastFrames) {
  RunStatistics statistics;
  for (std::size_t k = 0; k < RunStatistics::kWindow; ++k) statistics.add(report_with(1.0, 0));
  for (std::size_t k = 0; k < RunStatistics::kWindow; ++k) statistics.add(report_with(9.0, 0));
  EXPECT_EQ(statistics.median_stages().total_us, 9.0);
  EXPECT_EQ(statistics.frames(), 2 * RunStatistics::kWindow);
}

TEST(MessageLimiter, LetsOneThroughInEachIntervalAndCountsTheOthers) {
  MessageLimiter limiter(1s);
  const MessageLimiter::Time start{100s};
  std::uint64_t held_back = 9;
  EXPECT_TRUE(limiter.admit(start, held_back));
  EXPECT_EQ(held_back, 0u);
  EXPECT_FALSE(limiter.admit(start + 100ms, held_back));
  EXPECT_FALSE(limiter.admit(start + 900ms, held_back));
  EXPECT_TRUE(limiter.admit(start + 1s, held_back));
  EXPECT_EQ(held_back, 2u);
  limiter.reset();
  EXPECT_TRUE(limiter.admit(start + 1100ms, held_back));
}

TEST(Publisher, SaysTheSameAsTheReport) {
  FrameReport report;
  report.frame = 11;
  report.camera = "north";
  report.capture_ns = 1234567890123;
  report.stages = {1.0, 2.0, 3.0, 6.0};
  report.rejected.resize(4);
  report.rejected_not_listed = 2;
  RobotReport robot;
  robot.id = 5;
  robot.team = "blue";
  robot.pose_world_robot = {0.1, 0.2, 0.3};
  robot.covariance = Eigen::Vector3d(1.0, 2.0, 3.0).asDiagonal();
  robot.centre_px = {10.0, 20.0};
  robot.pixels = {50, 40};
  robot.marker_count = 2;
  robot.confidence = 0.9;
  report.robots.push_back(robot);

  WirePose pose;
  fill_pose(report, robot, 77, &pose);
  EXPECT_EQ(pose.camera, "north");
  EXPECT_EQ(pose.epoch, 77u);
  EXPECT_EQ(pose.frame, 11u);
  EXPECT_EQ(pose.capture_ns, report.capture_ns);
  EXPECT_EQ(pose.robot.team, "blue");
  EXPECT_EQ(pose.robot.robot, 5);
  EXPECT_EQ(pose.robot.pose_world_robot.heading_rad, 0.3);
  EXPECT_EQ(pose.robot.covariance, robot.covariance);
  EXPECT_EQ(pose.robot.v_px, 20.0);
  ASSERT_EQ(pose.robot.marker_count, 2u);
  EXPECT_EQ(pose.robot.pixels[1], 40u);
  EXPECT_EQ(pose.robot.confidence, 0.9);

  WireFrame frame;
  fill_frame(report, 77, &frame);
  EXPECT_EQ(frame.rejected, 6u);
  EXPECT_EQ(frame.stages.total_us, 6.0);
  ASSERT_EQ(frame.robots.size(), 1u);
  EXPECT_EQ(frame.robots[0].robot, 5);
}

}  // namespace
}  // namespace nadir::tracker
