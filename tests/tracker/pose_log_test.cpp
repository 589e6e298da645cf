#include "tracker/pose_log.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "vision/input/input_error.h"

namespace nadir::tracker {
namespace {

using nlohmann::json;

FrameReport one_robot() {
  FrameReport report;
  report.frame = 7;
  report.camera = "cam \"0\"\\";
  report.capture_ns = 1700000000123456789;
  report.stages = {10.04, 20.0, 3.0, 24.5};
  RobotReport robot;
  robot.id = 3;
  robot.team = "blue";
  robot.pose_world_robot = {0.123456789, -2.0, -3.0000000004};
  robot.covariance << 1.23456789e-7, -4.5e-9, 1e-6, -4.5e-9, 2e-7, 0.0, 1e-6, 0.0, 3.3333333333e-5;
  robot.centre_px = {320.12344, 240.0};
  robot.pixels = {55, 48};
  robot.marker_count = 2;
  robot.confidence = 0.98;
  report.robots.push_back(robot);
  report.rejected.push_back({{1.0, 2.0}, "no heading marker"});
  return report;
}

json parsed(const FrameReport& report) {
  fmt::memory_buffer line;
  append_json(report, line);
  return json::parse(std::string_view(line.data(), line.size()));
}

TEST(PoseLog, WritesEveryFieldOfAFrame) {
  const FrameReport report = one_robot();
  const json frame = parsed(report);
  EXPECT_EQ(frame.size(), 6u);
  EXPECT_EQ(frame["frame"], 7);
  EXPECT_EQ(frame["camera"], report.camera);
  EXPECT_EQ(frame["capture_ns"].get<std::int64_t>(), report.capture_ns);
  EXPECT_EQ(frame["stages_us"],
            (json{{"read", 10.0}, {"detect", 20.0}, {"map", 3.0}, {"total", 24.5}}));
  ASSERT_EQ(frame["robots"].size(), 1u);
  const json& robot = frame["robots"][0];
  EXPECT_EQ(robot.size(), 11u);
  EXPECT_EQ(robot["aligned"], false);
  EXPECT_EQ(robot["id"], 3);
  EXPECT_EQ(robot["team"], "blue");
  EXPECT_NEAR(robot["x_m"].get<double>(), 0.123456789, 1e-12);
  EXPECT_NEAR(robot["heading_rad"].get<double>(), -3.0, 1e-9);
  EXPECT_NEAR(robot["u_px"].get<double>(), 320.1234, 1e-9);
  EXPECT_EQ(robot["pixels"], (json{55, 48}));
  EXPECT_EQ(frame["rejected"],
            (json{{{"u_px", 1.0}, {"v_px", 2.0}, {"reason", "no heading marker"}}}));
}

TEST(PoseLog, KeepsTenDigitsOfTheCovariance) {
  const FrameReport report = one_robot();
  const auto written = parsed(report)["robots"][0]["covariance"].get<std::vector<double>>();
  ASSERT_EQ(written.size(), 9u);
  for (int i = 0; i < 9; ++i) {
    const double value = report.robots[0].covariance(i / 3, i % 3);
    EXPECT_NEAR(written[static_cast<std::size_t>(i)], value, 1e-9 * std::abs(value)) << i;
  }
}

TEST(PoseLog, WritesALineForAFrameWithoutRobots) {
  const json frame = parsed(FrameReport{});
  EXPECT_EQ(frame["robots"], json::array());
  EXPECT_EQ(frame["rejected"], json::array());
}

TEST(PoseLog, StaysJsonWhereANumberIsNotFinite) {
  FrameReport report = one_robot();
  report.robots[0].covariance(0, 0) = std::numeric_limits<double>::infinity();
  report.robots[0].pose_world_robot.x_m = std::nan("");
  EXPECT_TRUE(parsed(report)["robots"][0]["covariance"][0].is_null());
  EXPECT_TRUE(parsed(report)["robots"][0]["x_m"].is_null());
}

TEST(PoseLog, WritesOneLineForEachFrame) {
  const auto file = std::filesystem::path(testing::TempDir()) / "pose_log_test.jsonl";
  {
    PoseLog log(file);
    EXPECT_TRUE(log.write(one_robot()));
    EXPECT_TRUE(log.write(FrameReport{}));
  }
  std::ifstream in(file);
  std::string line;
  int lines = 0;
  for (; std::getline(in, line); ++lines) EXPECT_TRUE(json::accept(line)) << line;
  EXPECT_EQ(lines, 2);
  std::filesystem::remove(file);
}

TEST(PoseLog, SaysThatAFileCannotBeWritten) {
  EXPECT_THROW(PoseLog("/nowhere/poses.jsonl"), vision::InputError);
}

}  // namespace
}  // namespace nadir::tracker
