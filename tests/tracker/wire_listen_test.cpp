// nadir-listen as its users meet it: a process of its own beside a publisher.

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/support/loopback_dds.h"
#include "tests/support/test_poses.h"
#include "tests/support/test_values.h"

namespace nadir::tracker {
namespace {

using nlohmann::json;
using test::ChildProcess;

constexpr std::chrono::seconds kPatience{30};

class Listen : public testing::Test {
 protected:
  ChildProcess start(const char* program, std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--domain", std::to_string(dds_.domain())});
    return {program, arguments, dds_.environment()};
  }
  ChildProcess listen(const std::vector<std::string>& arguments) const {
    return start(NADIR_LISTEN, arguments);
  }
  ChildProcess publisher(const std::vector<std::string>& arguments) const {
    return start(NADIR_TEST_PUBLISHER, arguments);
  }

  test::LoopbackDds dds_;
};

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

/// The fields of a robot as the poses file has them, back into the value type.
WireRobot robot_from_json(const json& fields) {
  WireRobot robot;
  robot.team = fields.at("team");
  robot.robot = fields.at("id");
  robot.pose_world_robot = {fields.at("x_m"), fields.at("y_m"), fields.at("heading_rad")};
  EXPECT_EQ(fields.at("covariance").size(), 9U);
  for (int i = 0; i < 9; ++i) {
    robot.covariance(i / 3, i % 3) = fields.at("covariance").at(static_cast<std::size_t>(i));
  }
  robot.u_px = fields.at("u_px");
  robot.v_px = fields.at("v_px");
  robot.confidence = fields.at("confidence");
  for (const json& count : fields.at("pixels")) robot.pixels.at(robot.marker_count++) = count;
  return robot;
}

TEST_F(Listen, JsonLinesAreWhatWasPublished) {
  ChildProcess listener = listen({"--json", "--count", "60"});
  ChildProcess sender = publisher({"--epoch", "77", "--camera", "north \"1\""});
  ASSERT_EQ(listener.wait(kPatience), 0) << listener.err();
  const std::vector<std::string> printed = lines(listener.out());
  ASSERT_EQ(printed.size(), 60U);
  for (const std::string& line : printed) {
    const json fields = json::parse(line);
    WirePose pose;
    pose.robot = robot_from_json(fields);
    pose.camera = fields.at("camera");
    pose.epoch = fields.at("epoch");
    pose.frame = fields.at("frame");
    pose.capture_ns = fields.at("capture_ns");
    const WirePose sent = test::test_pose(77, pose.frame, pose.robot.robot, "north \"1\"");
    ASSERT_EQ(test::difference(pose, sent), "") << line;
    // Test poses are captured in 2023: the age is the time since.
    const double published_age_ms =
        static_cast<double>(fields.at("publish_ns").get<std::int64_t>() - pose.capture_ns) * 1e-6;
    ASSERT_GE(fields.at("age_ms").get<double>(), published_age_ms - 1.0);
  }
}

TEST_F(Listen, ColumnsShowOneRobotALine) {
  ChildProcess listener = listen({"--robot", "5", "--count", "5"});
  ChildProcess sender = publisher({});
  ASSERT_EQ(listener.wait(kPatience), 0) << listener.err();
  const std::vector<std::string> printed = lines(listener.out());
  ASSERT_EQ(printed.size(), 5U);
  for (const std::string& line : printed) {
    std::istringstream stream(line);
    std::string camera;
    std::string team;
    std::string bar;
    std::int32_t robot = 0;
    std::uint64_t frame = 0;
    double age_ms = 0.0;
    double x_m = 0.0;
    double y_m = 0.0;
    double heading_rad = 0.0;
    double sigma_x_m = 0.0;
    stream >> camera >> team >> robot >> frame >> age_ms >> bar >> x_m >> y_m >> heading_rad >>
        bar >> sigma_x_m;
    ASSERT_TRUE(stream) << line;
    const WirePose sent = test::test_pose(1, frame, 5);
    EXPECT_EQ(camera, "cam0");
    EXPECT_EQ(team, sent.robot.team);
    EXPECT_EQ(robot, 5);
    EXPECT_NEAR(x_m, sent.robot.pose_world_robot.x_m, 5.1e-5);
    EXPECT_NEAR(y_m, sent.robot.pose_world_robot.y_m, 5.1e-5);
    EXPECT_NEAR(heading_rad, sent.robot.pose_world_robot.heading_rad, 5.1e-5);
    EXPECT_NEAR(sigma_x_m * sigma_x_m, sent.robot.covariance(0, 0), 2e-7);
  }
}

TEST_F(Listen, FramesShowAlsoEmptyOnes) {
  ChildProcess listener = listen({"--frames", "--json", "--count", "20"});
  ChildProcess sender = publisher(
      {"--robots", "3", "--robots-until", "10", "--robots-later", "0", "--wait-for-readers", "1"});
  ASSERT_EQ(listener.wait(kPatience), 0) << listener.err();
  const std::vector<std::string> printed = lines(listener.out());
  ASSERT_EQ(printed.size(), 20U);
  bool empty_seen = false;
  for (const std::string& line : printed) {
    const json fields = json::parse(line);
    const std::uint64_t number = fields.at("frame");
    const WireFrame sent = test::test_frame(1, number, number < 10 ? 3 : 0);
    ASSERT_EQ(fields.at("robots").size(), sent.robots.size());
    for (std::size_t i = 0; i < sent.robots.size(); ++i) {
      ASSERT_EQ(test::difference(robot_from_json(fields.at("robots").at(i)), sent.robots[i]), "");
    }
    EXPECT_EQ(fields.at("rejected"), sent.rejected);
    EXPECT_EQ(fields.at("stages_us").at("total"), sent.stages.total_us);
    empty_seen = empty_seen || sent.robots.empty();
  }
  EXPECT_TRUE(empty_seen);
}

TEST_F(Listen, ClientsAsJsonAreWhatTheySaid) {
  ChildProcess listener = listen({"--clients", "--json", "--robot", "1", "--count", "30"});
  ChildProcess sender = start(NADIR_TEST_PEER, {"state"});
  ASSERT_EQ(listener.wait(kPatience), 0) << listener.err();
  const std::vector<std::string> printed = lines(listener.out());
  ASSERT_EQ(printed.size(), 30U);
  for (const std::string& line : printed) {
    const json fields = json::parse(line);
    const WireClientState sent = test::test_state(fields.at("sequence"), 1);
    EXPECT_EQ(fields.at("id"), 1);
    EXPECT_EQ(fields.at("team"), sent.team);
    EXPECT_EQ(fields.at("mode"), name_of(sent.mode));
    EXPECT_EQ(fields.at("reason"), name_of(sent.reason));
    EXPECT_EQ(fields.at("text"), sent.text);
    EXPECT_EQ(fields.at("estimate").at("heading_rad"), sent.estimate_world_robot.heading_rad);
    EXPECT_EQ(fields.at("nominal").at("x_m"), sent.nominal_world_robot.x_m);
    EXPECT_EQ(fields.at("covariance").at(5), sent.covariance(1, 2));
    EXPECT_EQ(fields.at("error_left_m"), sent.error_left_m);
    EXPECT_EQ(fields.at("pose_age_ns"), sent.pose_age_ns);
    EXPECT_EQ(fields.at("poses").at("lost"), sent.counts.poses_lost);
    EXPECT_EQ(fields.at("ticks_missed"), sent.counts.ticks_missed);
    EXPECT_EQ(fields.at("clock_offset_ns"), sent.clock_offset_ns);
  }
}

TEST_F(Listen, ClientsInColumnsShowModeEstimateAndError) {
  ChildProcess listener = listen({"--clients", "--count", "5"});
  ChildProcess sender = start(NADIR_TEST_PEER, {"state", "--robots", "1"});
  ASSERT_EQ(listener.wait(kPatience), 0) << listener.err();
  EXPECT_NE(listener.err().find("missed"), std::string::npos);  // the header
  for (const std::string& line : lines(listener.out())) {
    const std::size_t place = line.find("| state ");  // the text names the sequence number
    ASSERT_NE(place, std::string::npos) << line;
    const WireClientState sent = test::test_state(std::stoull(line.substr(place + 8)), 0);
    EXPECT_EQ(line.find("blue        0 " + std::string(name_of(sent.mode))), 0U) << line;
    EXPECT_NE(line.find(name_of(sent.reason)), std::string::npos) << line;
    std::istringstream stream(line.substr(line.find('|') + 1));
    std::string bar;
    double x_m = 0.0;
    double y_m = 0.0;
    double heading_rad = 0.0;
    double ahead_mm = 0.0;
    stream >> x_m >> y_m >> heading_rad >> bar >> ahead_mm;
    ASSERT_TRUE(stream) << line;
    EXPECT_NEAR(x_m, sent.estimate_world_robot.x_m, 5.1e-5);
    EXPECT_NEAR(ahead_mm, 1e3 * sent.error_ahead_m, 5.1e-3);
  }
}

TEST_F(Listen, SaysWhyNoClientIsHeard) {
  ChildProcess sender = publisher({});
  ChildProcess listener = listen({"--clients"});
  EXPECT_TRUE(listener.wait_for_err("is nadir-client drive running", kPatience)) << listener.err();
}

TEST_F(Listen, SaysWhyNothingComes) {
  ChildProcess listener = listen({});
  ASSERT_TRUE(listener.wait_for_err("nobody else is in this domain", kPatience)) << listener.err();
  const std::string words = listener.err();
  EXPECT_NE(words.find("DDS domain " + std::to_string(dds_.domain())), std::string::npos) << words;
  EXPECT_NE(words.find("matched writers: 0"), std::string::npos) << words;
  EXPECT_NE(words.find("lo 127.0.0.1"), std::string::npos) << words;
  EXPECT_NE(words.find("start nadir-tracker"), std::string::npos) << words;
  EXPECT_EQ(listener.out(), "");
}

TEST_F(Listen, SaysThatTheFilterLetsNothingPass) {
  ChildProcess sender = publisher({});
  ChildProcess listener = listen({"--robot", "99"});
  ASSERT_TRUE(listener.wait_for_err("no pose passes --robot 99", kPatience)) << listener.err();
  EXPECT_NE(listener.err().find("matched writers: 1 (alive: 1)"), std::string::npos);
}

TEST_F(Listen, SaysThatTheTrackerFellSilent) {
  ChildProcess sender = publisher({});
  ChildProcess listener = listen({"--json"});
  ASSERT_TRUE(listener.wait_for_out("capture_ns", kPatience));
  sender.signal(SIGKILL);
  EXPECT_TRUE(listener.wait_for_err("fell silent", kPatience)) << listener.err();
}

TEST_F(Listen, InterruptIsACleanEnd) {
  ChildProcess sender = publisher({});
  ChildProcess listener = listen({"--json"});
  ASSERT_TRUE(listener.wait_for_out("capture_ns", kPatience));
  listener.signal(SIGINT);
  EXPECT_EQ(listener.wait(kPatience), 0);
  const std::vector<std::string> printed = lines(listener.out());
  ASSERT_FALSE(printed.empty());
  EXPECT_TRUE(json::accept(printed.back()));  // no line is cut in half
}

TEST_F(Listen, WrongUsageEndsWithTwo) {
  const std::vector<std::vector<std::string>> wrong = {{"--domain", "102"},
                                                       {"--domain", "x"},
                                                       {"--count", "0"},
                                                       {"--no-such-option"},
                                                       {"--frames", "--robot", "1"},
                                                       {"--clients", "--frames"}};
  for (const std::vector<std::string>& arguments : wrong) {
    ChildProcess listener(NADIR_LISTEN, arguments, dds_.environment());
    EXPECT_EQ(listener.wait(kPatience), 2) << arguments[0];
    EXPECT_NE(listener.err(), "");
    EXPECT_EQ(listener.out(), "");
  }
}

TEST_F(Listen, HelpHasAnExampleAndVersionIsPrinted) {
  ChildProcess help(NADIR_LISTEN, {"--help"});
  EXPECT_EQ(help.wait(kPatience), 0);
  EXPECT_NE(help.out().find("Example: nadir-listen"), std::string::npos);
  ChildProcess version(NADIR_LISTEN, {"--version"});
  EXPECT_EQ(version.wait(kPatience), 0);
  EXPECT_EQ(version.out(), "nadir-listen " NADIR_VERSION "\n");
}

}  // namespace
}  // namespace nadir::tracker
