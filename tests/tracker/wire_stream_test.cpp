// Poses between real processes: the publisher is a child, the reader is this process.

#include <gtest/gtest.h>

#include <csignal>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/support/loopback_dds.h"
#include "tests/support/test_poses.h"
#include "tracker/wire/pose_reader.h"
#include "tracker/wire/pose_writer.h"

namespace nadir::tracker {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::ChildProcess;

constexpr seconds kPatience{30};  // for what takes milliseconds on an idle machine

class PoseStream : public testing::Test {
 protected:
  ReaderOptions reader_options() const {
    ReaderOptions options;
    options.wire.domain = dds_.domain();
    options.queue_capacity = 8192;  // these tests count losses of the network, not of the queue
    return options;
  }

  ChildProcess publisher(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--domain", std::to_string(dds_.domain())});
    return {NADIR_TEST_PUBLISHER, arguments, dds_.environment()};
  }

  template <typename Reader>
  static testing::AssertionResult reaches(const Reader& reader,
                                          const std::function<bool(const ReaderStatus&)>& goal) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < end) {
      if (goal(reader.status())) return testing::AssertionSuccess();
      std::this_thread::sleep_for(milliseconds(10));
    }
    const ReaderStatus status = reader.status();
    return testing::AssertionFailure()
           << "matched " << status.matched_writers << ", alive " << status.alive_writers
           << ", received " << status.received << ", lost writers " << status.writers_lost;
  }

  test::LoopbackDds dds_;
};

TEST_F(PoseStream, NoPoseOfTwelveRobotsAtHundredHertzIsLost) {
  constexpr std::uint64_t kFrames = 400;
  PoseReader reader(reader_options());
  ChildProcess child =
      publisher({"--frames", std::to_string(kFrames), "--wait-for-readers", "1", "--linger", "60"});
  std::map<std::int32_t, std::vector<std::uint64_t>> frames;
  WirePose pose;
  while (frames.size() < 12 || frames.rbegin()->second.back() != kFrames - 1) {
    ASSERT_TRUE(reader.poll(&pose, kPatience)) << child.err();
    ASSERT_EQ(test::difference(pose, test::test_pose(1, pose.frame, pose.robot.robot)), "");
    ASSERT_GT(pose.publish_ns, pose.capture_ns);
    frames[pose.robot.robot].push_back(pose.frame);
  }
  // The writer may know the reader a moment earlier than the other way round: from the first pose
  // on.
  for (const auto& [robot, seen] : frames) {
    EXPECT_GE(seen.size(), 300U) << "robot " << robot;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      ASSERT_EQ(seen[i], seen.front() + i) << "robot " << robot;
    }
    EXPECT_EQ(seen.back(), kFrames - 1) << "robot " << robot;
  }
  const ReaderStatus status = reader.status();
  EXPECT_EQ(status.dropped, 0U);
  EXPECT_EQ(status.malformed, 0U);
  EXPECT_EQ(status.matched_writers, 1);
}

TEST_F(PoseStream, CallbackSeesEachPoseOnce) {
  std::mutex mutex;
  std::vector<std::uint64_t> frames;
  PoseReader reader(reader_options(), [&](const WirePose& pose) {
    const std::lock_guard lock(mutex);
    frames.push_back(pose.frame);
  });
  ChildProcess child =
      publisher({"--robots", "1", "--frames", "50", "--wait-for-readers", "1", "--linger", "60"});
  ASSERT_TRUE(child.wait_for_out("published", kPatience)) << child.err();
  const auto last_is_here = [&](const ReaderStatus&) {
    const std::lock_guard lock(mutex);
    return !frames.empty() && frames.back() == 49;
  };
  ASSERT_TRUE(reaches(reader, last_is_here));
  for (std::size_t i = 0; i < frames.size(); ++i) ASSERT_EQ(frames[i], frames.front() + i);
  WirePose pose;
  EXPECT_FALSE(reader.poll(&pose, milliseconds(0)));
}

TEST_F(PoseStream, OwnRobotOnly) {
  ReaderOptions options = reader_options();
  options.filter = {.robot = 3, .team = "yellow", .camera = "cam0"};
  PoseReader reader(options);
  options.filter = {.robot = 3, .team = "blue", .camera = ""};  // robot 3 is yellow
  PoseReader other_team(options);
  ChildProcess child = publisher({"--wait-for-readers", "2"});
  WirePose pose;
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(reader.poll(&pose, kPatience));
    ASSERT_EQ(pose.robot.robot, 3);
  }
  EXPECT_EQ(other_team.status().received, 0U);
}

TEST_F(PoseStream, LateJoinerStartsWithTheNextFrame) {
  ChildProcess child = publisher({"--robots", "2"});
  ASSERT_TRUE(child.wait_for_out("publishing", kPatience));
  std::this_thread::sleep_for(milliseconds(300));  // so that there is something to miss
  PoseReader reader(reader_options());
  WirePose pose;
  ASSERT_TRUE(reader.poll(&pose, kPatience));
  EXPECT_GT(pose.frame, 0U);  // the past is not for robots
  const std::uint64_t first = pose.frame;
  while (pose.frame < first + 20) ASSERT_TRUE(reader.poll(&pose, kPatience));
}

TEST_F(PoseStream, RestartedTrackerIsANewEpoch) {
  PoseReader reader(reader_options());
  WirePose pose;
  {
    ChildProcess first = publisher({"--epoch", "100", "--robots", "1"});
    while (pose.frame < 20) ASSERT_TRUE(reader.poll(&pose, kPatience));
    EXPECT_EQ(pose.epoch, 100U);
  }  // killed, without a good-bye
  ChildProcess second = publisher({"--epoch", "200", "--robots", "1"});
  while (pose.epoch == 100) ASSERT_TRUE(reader.poll(&pose, kPatience));
  EXPECT_EQ(pose.epoch, 200U);
  EXPECT_EQ(test::difference(pose, test::test_pose(200, pose.frame, 0)), "");
}

TEST_F(PoseStream, KilledTrackerIsNoticed) {
  PoseReader reader(reader_options());
  ChildProcess child = publisher({});
  ASSERT_TRUE(reaches(reader, [](const ReaderStatus& s) { return s.received > 100; }));
  EXPECT_EQ(reader.status().alive_writers, 1);
  child.signal(SIGKILL);
  // Noticed by its lease; the participant itself stays matched for its own, much longer one.
  EXPECT_TRUE(reaches(
      reader, [](const ReaderStatus& s) { return s.alive_writers == 0 && s.writers_lost >= 1; }));
}

TEST_F(PoseStream, TrackerThatSaysGoodByeIsNotLost) {
  PoseReader reader(reader_options());
  ChildProcess child = publisher({});
  ASSERT_TRUE(reaches(reader, [](const ReaderStatus& s) { return s.received > 100; }));
  const std::uint64_t lost_before = reader.status().writers_lost;
  child.signal(SIGTERM);
  EXPECT_TRUE(reaches(reader, [](const ReaderStatus& s) { return s.matched_writers == 0; }));
  EXPECT_EQ(child.wait(kPatience), 0);
  EXPECT_EQ(reader.status().writers_lost, lost_before);
}

TEST_F(PoseStream, RobotThatIsGoneMissesDeadlinesUntilItIsRetired) {
  PoseReader reader(reader_options());
  // Robot 1 is seen for a second and then no more; robot 0 goes on.
  ChildProcess child = publisher(
      {"--robots", "2", "--robots-until", "100", "--robots-later", "1", "--wait-for-readers", "1"});
  ASSERT_TRUE(reaches(reader, [](const ReaderStatus& s) { return s.deadlines_missed > 0; }));
  std::uint64_t before = 0;
  const auto quiet_for_a_second = [&](const ReaderStatus& status) {
    const bool quiet = status.deadlines_missed == before;
    before = status.deadlines_missed;
    std::this_thread::sleep_for(seconds(1));
    return quiet && reader.status().deadlines_missed == before;
  };
  EXPECT_TRUE(reaches(reader, quiet_for_a_second));
}

TEST_F(PoseStream, PartitionsDoNotMeet) {
  ReaderOptions options = reader_options();
  options.wire.partition = "field-a";
  PoseReader same(options);
  options.wire.partition = "field-b";
  PoseReader other(options);
  ChildProcess child = publisher({"--partition", "field-a"});
  ASSERT_TRUE(reaches(same, [](const ReaderStatus& s) { return s.received > 100; }));
  EXPECT_EQ(other.status().received, 0U);
  EXPECT_EQ(other.status().matched_writers, 0);
  EXPECT_GE(other.status().peers, 1);
}

TEST_F(PoseStream, SlowReaderLosesTheOldestAndKnowsIt) {
  ReaderOptions options = reader_options();
  options.queue_capacity = 10;
  PoseReader reader(options);
  ChildProcess child =
      publisher({"--robots", "1", "--frames", "100", "--wait-for-readers", "1", "--linger", "60"});
  ASSERT_TRUE(child.wait_for_out("published", kPatience)) << child.err();
  ASSERT_TRUE(reaches(reader, [](const ReaderStatus& s) { return s.dropped >= 50; }));
  WirePose pose;
  std::uint64_t taken = 0;
  while (reader.poll(&pose, milliseconds(200))) ++taken;
  EXPECT_EQ(taken, 10U);
  EXPECT_EQ(pose.frame, 99U);
  EXPECT_EQ(reader.status().dropped + taken, reader.status().received);
}

TEST_F(PoseStream, MonitorSeesEveryFrameAlsoEmptyOnes) {
  FrameReader reader(reader_options());
  ChildProcess child = publisher({"--robots", "12", "--robots-until", "60", "--robots-later", "0",
                                  "--frames", "120", "--wait-for-readers", "1", "--linger", "60"});
  WireFrame frame;
  ASSERT_TRUE(reader.poll(&frame, kPatience));
  std::uint64_t expected = frame.frame;
  std::uint64_t empty = 0;
  while (true) {
    ASSERT_EQ(frame.frame, expected++);
    const std::int32_t robots = frame.frame < 60 ? 12 : 0;
    ASSERT_EQ(test::difference(frame, test::test_frame(1, frame.frame, robots)), "");
    if (frame.robots.empty()) ++empty;
    if (frame.frame == 119) break;
    ASSERT_TRUE(reader.poll(&frame, kPatience));
  }
  EXPECT_GE(empty, 60U);
}

TEST_F(PoseStream, WriterCountsWhatItRefuses) {
  PoseWriter writer(reader_options().wire);
  std::vector<WirePose> poses = {test::test_pose(1, 1, 0), test::test_pose(1, 1, 1)};
  poses[0].robot.team = "a team with too long a name";
  writer.publish(poses);
  WireFrame frame = test::test_frame(1, 1, 2);
  frame.robots[1].confidence = 2.0;
  writer.publish(frame);
  const PoseWriter::Status status = writer.status();
  EXPECT_EQ(status.published_poses, 1U);
  EXPECT_EQ(status.published_frames, 0U);
  EXPECT_EQ(status.refused, 2U);
  EXPECT_EQ(status.failed, 0U);
}

TEST(WireErrors, ImpossibleDomainIsOneClearError) {
  try {
    const PoseWriter writer({.domain = 500, .partition = ""});
    FAIL() << "no error";
  } catch (const WireError& error) {
    EXPECT_NE(std::string(error.what()).find("domain 500"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("0 to 101"), std::string::npos) << error.what();
  }
}

TEST(WireErrors, BrokenConfigurationIsOneClearError) {
  setenv("CYCLONEDDS_URI", "<CycloneDDS><Domain><NoSuchThing/></Domain></CycloneDDS>", 1);
  try {
    const PoseReader reader(ReaderOptions{});
    FAIL() << "no error";
  } catch (const WireError& error) {
    EXPECT_NE(std::string(error.what()).find("CYCLONEDDS_URI"), std::string::npos) << error.what();
  }
  unsetenv("CYCLONEDDS_URI");
}

}  // namespace
}  // namespace nadir::tracker
