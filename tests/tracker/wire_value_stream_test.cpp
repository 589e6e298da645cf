// Robots' and clients' streams between real processes: the other side is a child.

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <functional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/support/loopback_dds.h"
#include "tests/support/test_values.h"
#include "tracker/wire/clock_exchange.h"
#include "tracker/wire/pose_reader.h"
#include "tracker/wire/value_streams.h"

namespace nadir::tracker {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::ChildProcess;

constexpr seconds kPatience{30};  // for what takes milliseconds on an idle machine

class ValueStream : public testing::Test {
 protected:
  explicit ValueStream(double loss = 0.0) : dds_(loss) {}

  ChildProcess peer(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--domain", std::to_string(dds_.domain())});
    return {NADIR_TEST_PEER, arguments, dds_.environment()};
  }

  static bool becomes_true(const std::function<bool()>& goal) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < end) {
      if (goal()) return true;
      std::this_thread::sleep_for(milliseconds(10));
    }
    return false;
  }

  test::LoopbackDds dds_;
  Participant participant_{WireOptions{dds_.domain(), ""}};
};

/// Values of robot 1 must come whole and in order.
template <typename Value>
void expect_stream(const Participant& participant, const ChildProcess& child,
                   Value (*make)(std::uint64_t, std::int32_t),
                   std::uint64_t (*number)(const Value&)) {
  ValueReader<Value> reader(participant, {.robot = 1, .team = "yellow"}, 1024);
  Value value;
  std::uint64_t last = 0;
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(reader.poll(&value, kPatience)) << child.err();
    ASSERT_EQ(test::difference(value, make(number(value), 1)), "");
    ASSERT_TRUE(i == 0 || number(value) > last);
    last = number(value);
  }
  const ReaderStatus status = reader.status();
  EXPECT_EQ(status.malformed, 0U);
  EXPECT_EQ(status.matched_writers, 1);
  EXPECT_EQ(status.peers, 1);
}

template <typename Value>
std::uint64_t sequence_of(const Value& value) {
  return value.sequence;
}

TEST_F(ValueStream, CommandsReachTheirRobot) {
  const ChildProcess child = peer({"commands"});
  expect_stream<WireWheelCommand>(participant_, child, test::test_command, sequence_of);
}

TEST_F(ValueStream, OdometryReachesItsClient) {
  const ChildProcess child = peer({"odometry"});
  expect_stream<WireOdometry>(participant_, child, test::test_odometry, sequence_of);
}

TEST_F(ValueStream, ClientStatesReachMonitors) {
  const ChildProcess child = peer({"state"});
  expect_stream<WireClientState>(participant_, child, test::test_state, sequence_of);
}

TEST_F(ValueStream, TruthOfSimulatedRobotsArrives) {
  const ChildProcess child = peer({"truth"});
  expect_stream<WireSimulatedTruth>(
      participant_, child, test::test_truth, [](const WireSimulatedTruth& truth) {
        const std::int64_t since_ns = truth.time_ns - test::test_truth(0, 0).time_ns;
        return static_cast<std::uint64_t>(since_ns / 5'000'000);
      });
}

TEST_F(ValueStream, CallbackGetsValuesInsteadOfTheQueue) {
  std::atomic<int> called{0};
  OdometryReader reader(participant_, {}, [&called](const WireOdometry&) { ++called; });
  const ChildProcess child = peer({"odometry"});
  EXPECT_TRUE(becomes_true([&] { return called > 20; })) << child.err();
  WireOdometry odometry;
  EXPECT_FALSE(reader.poll(&odometry, milliseconds(0)));
}

TEST_F(ValueStream, SilentClientCountsAsLostThoughItsProcessLives) {
  WheelCommandReader reader(participant_, {.robot = 1, .team = ""});
  ChildProcess child = peer({"commands", "--values", "40"});
  ASSERT_TRUE(becomes_true([&] { return reader.status().alive_writers == 1; })) << child.err();
  ASSERT_TRUE(child.wait_for_out("written", kPatience)) << child.err();
  EXPECT_TRUE(becomes_true([&] { return reader.status().alive_writers == 0; }));
  EXPECT_EQ(reader.status().matched_writers, 1);
  EXPECT_GE(reader.status().writers_lost, 1U);
  EXPECT_FALSE(child.wait(milliseconds(0)).has_value());
}

TEST_F(ValueStream, SignOfLifeIsEnoughToStay) {
  WheelCommandReader reader(participant_, {.robot = 1, .team = ""});
  ChildProcess child = peer({"commands", "--values", "10", "--assert-afterwards"});
  ASSERT_TRUE(child.wait_for_out("written", kPatience)) << child.err();
  ASSERT_TRUE(becomes_true([&] { return reader.status().alive_writers == 1; })) << child.err();
  // Many leases later, without a command: if the machine held the client up meanwhile, its next
  // sign of life brings it back.
  std::this_thread::sleep_for(5 * kLivelinessLease);
  EXPECT_TRUE(becomes_true([&] { return reader.status().alive_writers == 1; }));
}

TEST_F(ValueStream, KilledClientIsNoticed) {
  WheelCommandReader reader(participant_);
  ClientStateReader states(participant_);
  ChildProcess child = peer({"commands"});
  ChildProcess other = peer({"state"});
  ASSERT_TRUE(becomes_true([&] {
    return reader.status().alive_writers == 1 && states.status().alive_writers == 1;
  })) << child.err();
  child.signal(SIGKILL);
  other.signal(SIGKILL);
  EXPECT_TRUE(becomes_true(
      [&] { return reader.status().alive_writers == 0 && states.status().alive_writers == 0; }));
}

TEST_F(ValueStream, LateJoinerGetsTheStopThatHolds) {
  ChildProcess child = peer({"stop"});
  ASSERT_TRUE(child.wait_for_out("written", kPatience)) << child.err();
  EmergencyStopReader reader(participant_, {.robot = 3, .team = "yellow"});
  EmergencyStopReader other(participant_, {.robot = 3, .team = "blue"});
  WireEmergencyStop stop;
  ASSERT_TRUE(reader.poll(&stop, kPatience));
  EXPECT_EQ(test::difference(stop, test::test_stop(3)), "");
  EXPECT_FALSE(other.poll(&stop, milliseconds(0)));
}

TEST_F(ValueStream, StopForEverybodyPassesEveryFilterAndOutlivesItsWriter) {
  EmergencyStopReader reader(participant_, {.robot = 7, .team = "blue"});
  EmergencyStops stops;
  WireEmergencyStop stop;
  {
    ChildProcess child = peer({"stop", "--everybody"});
    ASSERT_TRUE(reader.poll(&stop, kPatience)) << child.err();
    stops.apply(stop);
  }  // killed
  EXPECT_NE(stops.engaged("blue", 7), nullptr);
  // Somebody else may release it.
  ChildProcess release = peer({"stop", "--everybody", "--release"});
  ASSERT_TRUE(reader.poll(&stop, kPatience)) << release.err();
  stops.apply(stop);
  EXPECT_EQ(stops.engaged("blue", 7), nullptr);
  EXPECT_EQ(release.wait(kPatience), 0) << release.err();
}

TEST_F(ValueStream, WriterCountsWhatItRefuses) {
  OdometryWriter writer(participant_);
  EXPECT_TRUE(writer.write(test::test_odometry(1, 1)));
  WireOdometry impossible = test::test_odometry(2, 1);
  impossible.t_to_ns = impossible.t_from_ns;
  EXPECT_FALSE(writer.write(impossible));
  const WriterStatus status = writer.status();
  EXPECT_EQ(status.published, 1U);
  EXPECT_EQ(status.refused, 1U);
  EXPECT_EQ(status.failed, 0U);
}

TEST_F(ValueStream, OneProcessIsOneParticipantWhateverItReadsAndWrites) {
  const Participant monitor(WireOptions{dds_.domain(), ""});
  PoseReader poses(participant_, ReaderOptions{});
  OdometryReader odometry(participant_);
  EmergencyStopReader stops(participant_);
  WheelCommandWriter commands(participant_);
  ClientStateWriter states(participant_);
  ClockAsker asker(participant_, 1, system_clock_ns);
  const ClientStateReader reader(monitor);
  ASSERT_TRUE(becomes_true([&] { return reader.status().matched_writers == 1; }));
  EXPECT_EQ(monitor.peers(), 1);
}

/// One packet in five is lost, on both sides.
class LossyStream : public ValueStream {
 protected:
  LossyStream() : ValueStream(0.2) {}
};

TEST_F(LossyStream, EmergencyStopArrivesAllTheSame) {
  EmergencyStopReader early(participant_);
  WireEmergencyStop stop;
  const ChildProcess child = peer({"stop"});
  ASSERT_TRUE(early.poll(&stop, kPatience)) << child.err();
  EmergencyStopReader late(participant_);
  ASSERT_TRUE(late.poll(&stop, kPatience)) << child.err();
  EXPECT_EQ(test::difference(stop, test::test_stop(3)), "");
}

TEST_F(LossyStream, TheLastCommandArrivesAllTheSame) {
  WheelCommandReader reader(participant_, {.robot = 1, .team = ""}, 1024);
  // The writer goes on asserting its liveliness: that is what makes a loss known.
  const ChildProcess child = peer({"commands", "--values", "100", "--assert-afterwards"});
  WireWheelCommand command;
  std::uint64_t last = 0;
  while (last < 99) {
    ASSERT_TRUE(reader.poll(&command, kPatience)) << child.err();
    ASSERT_TRUE(last == 0 || command.sequence > last);
    last = command.sequence;
  }
}

class ClockStream : public ValueStream {
 protected:
  static constexpr std::int64_t kSecond_ns = 1'000'000'000;

  /// Asks until `wanted` answers are there.
  static std::vector<ClockExchange> ask(ClockAsker& asker, std::size_t wanted) {
    std::vector<ClockExchange> answers;
    ClockExchange exchange;
    becomes_true([&] {
      asker.ask();
      while (asker.poll(&exchange, milliseconds(1))) answers.push_back(exchange);
      return answers.size() >= wanted;
    });
    return answers;
  }
};

TEST_F(ClockStream, ClientWithAWrongClockLearnsTheOffset) {
  // The tracker is 5 s ahead of this machine, the client 2.25 s behind it.
  const ChildProcess child = peer({"clock", "--clock-error", "5", "--epoch", "77"});
  ClockAsker asker(participant_, 12, [] { return system_clock_ns() - 9 * kSecond_ns / 4; });
  const std::vector<ClockExchange> answers = ask(asker, 10);
  ASSERT_GE(answers.size(), 10U) << child.err();
  constexpr std::int64_t kTrueOffset_ns = 5 * kSecond_ns + 9 * kSecond_ns / 4;
  for (const ClockExchange& answer : answers) {
    EXPECT_EQ(answer.epoch, 77U);
    EXPECT_GE(answer.round_trip_ns(), 0);
    // Not a matter of speed: the error is at most half the round trip, however long that took.
    EXPECT_LE(std::abs(answer.offset_ns() - kTrueOffset_ns), answer.round_trip_ns() / 2 + 1);
  }
}

TEST_F(ClockStream, EachClientGetsItsOwnAnswersFromEachTracker) {
  const ChildProcess first = peer({"clock", "--epoch", "1"});
  const ChildProcess second = peer({"clock", "--epoch", "2", "--clock-error", "60"});
  ClockAsker asker(participant_, 1, system_clock_ns);
  ClockAsker other(participant_, 2, system_clock_ns);
  std::set<std::uint64_t> epochs;
  ASSERT_TRUE(becomes_true([&] {
    for (const ClockExchange& answer : ask(asker, 1)) {
      epochs.insert(answer.epoch);
      const bool ahead = answer.offset_ns() > 30 * kSecond_ns;
      EXPECT_EQ(ahead, answer.epoch == 2);
    }
    return epochs.size() == 2;
  })) << first.err()
      << second.err();
  ClockExchange exchange;
  EXPECT_FALSE(other.poll(&exchange, milliseconds(0)));  // it did not ask
}

TEST_F(ClockStream, AnswererCountsItsAnswers) {
  const ClockAnswerer answerer(participant_, 9);
  const Participant client(WireOptions{dds_.domain(), ""});
  ClockAsker asker(client, 3, system_clock_ns);
  EXPECT_GE(ask(asker, 3).size(), 3U);
  EXPECT_GE(answerer.status().answered, 3U);
  EXPECT_EQ(answerer.status().failed, 0U);
  EXPECT_EQ(answerer.status().malformed, 0U);
}

}  // namespace
}  // namespace nadir::tracker
