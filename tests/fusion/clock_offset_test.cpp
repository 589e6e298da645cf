#include "fusion/clock_offset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace nadir::fusion {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;

/// Robot and server with clocks of their own, and a network between them. Time is the robot's.
class TwoClocks {
 public:
  double offset_s = 1.7e9;  ///< server minus robot at the robot's time 100 s
  double drift_ppm = 50.0;
  double out_s = 0.4e-3;          ///< shortest way to the server
  double back_s = 0.4e-3;         ///< shortest way to the robot
  double out_jitter_s = 0.3e-3;   ///< mean of what is added, exponential
  double back_jitter_s = 1.5e-3;  ///< mean of what is added, exponential
  double loss = 0.2;

  Timestamp now{seconds(100)};

  /// Exact, to the nanosecond.
  nanoseconds offset_at(Timestamp robot) const {
    return seconds(static_cast<std::int64_t>(offset_s)) +
           from_seconds(offset_s - std::floor(offset_s)) +
           from_seconds(1e-6 * drift_ppm * to_seconds(robot - seconds(100)));
  }

  /// Nothing where the question or the answer was lost.
  std::optional<ClockExchange> exchange() {
    std::exponential_distribution<double> wait(1.0);
    ClockExchange stamps;
    const Timestamp arrived = now + from_seconds(out_s + out_jitter_s * wait(random_));
    const Timestamp answered = arrived + from_seconds(50e-6 * wait(random_));
    const Timestamp returned = answered + from_seconds(back_s + back_jitter_s * wait(random_));
    stamps.robot_sent = now;
    stamps.server_received = arrived + offset_at(arrived);
    stamps.server_sent = answered + offset_at(answered);
    stamps.robot_received = returned;
    if (std::uniform_real_distribution<double>()(random_) < loss) return std::nullopt;
    return stamps;
  }

 private:
  std::mt19937_64 random_{7};
};

double error_s(const ClockReading& reading, const TwoClocks& clocks) {
  return to_seconds(reading.offset - clocks.offset_at(clocks.now));
}

/// Ten exchanges a second; `look` once a second.
template <class Look>
void run(TwoClocks& clocks, ClockOffset& offset, int duration_s, Look look) {
  for (int i = 0; i < 10 * duration_s; ++i) {
    clocks.now += milliseconds(100);
    if (const auto exchange = clocks.exchange()) offset.add(*exchange);
    if (i % 10 == 9) look(*offset.at(clocks.now));
  }
}

TEST(ClockOffset, KnowsNothingBeforeTheFirstExchange) {
  const ClockOffset offset;
  EXPECT_FALSE(offset.at(seconds(1)));
  EXPECT_FALSE(offset.robot_time(seconds(1)));
}

TEST(ClockOffset, OneExchangeIsTheMiddleOfItsStamps) {
  ClockOffset offset;
  const auto at = [](std::int64_t ms) { return Timestamp(milliseconds(ms)); };
  EXPECT_EQ(offset.add({at(1000), at(5003), at(5004), at(1011)}), ClockVerdict::kUsed);
  // (5003 - 1000 + 5004 - 1011) / 2 = 3998 ms, wrong by at most (11 - 1) / 2 = 5 ms.
  const ClockReading reading = *offset.at(at(1005));
  EXPECT_NEAR(to_seconds(reading.offset), 3.998, 1e-6);
  EXPECT_NEAR(reading.bound_s, 0.005, 1e-4);
  EXPECT_NEAR(to_seconds(*offset.robot_time(at(5003))), 1.005, 1e-6);
  // Without drift known, an hour later all may be off by 200 ppm.
  EXPECT_GT(offset.at(at(3'601'000))->bound_s, 0.15 * 3600e-3);
}

TEST(ClockOffset, BoundAlwaysHoldsAndSigmaIsHonestUnderAsymmetricJitterDriftAndLoss) {
  TwoClocks clocks;
  ClockOffset offset;
  int looks = 0;
  int within_two_sigma = 0;
  double squares = 0.0;
  double sigma_squares = 0.0;
  run(clocks, offset, 600, [&](const ClockReading& reading) {
    const double error = error_s(reading, clocks);
    EXPECT_LE(std::abs(error), reading.bound_s);
    if (to_seconds(clocks.now) < 110.0) return;
    ++looks;
    within_two_sigma += std::abs(error) <= 2.0 * reading.sigma_s ? 1 : 0;
    squares += error * error;
    sigma_squares += reading.sigma_s * reading.sigma_s;
    EXPECT_LT(reading.bound_s, 2e-3);
  });
  EXPECT_GE(within_two_sigma, looks * 95 / 100);
  const double rms = std::sqrt(squares / looks);
  EXPECT_LT(rms, 150e-6);
  EXPECT_LT(std::sqrt(sigma_squares / looks), 4.0 * rms + 20e-6);  // and no excuse
  const ClockReading last = *offset.at(clocks.now);
  EXPECT_NEAR(last.drift_ppm, 50.0, 3.0 * last.drift_sigma_ppm + 0.5);
  EXPECT_LT(last.drift_sigma_ppm, 3.0);
  EXPECT_EQ(offset.count(ClockVerdict::kStepped), 0U);
  EXPECT_EQ(offset.count(ClockVerdict::kContradicts), 0U);
}

TEST(ClockOffset, ConstantDifferenceOfTheTwoWaysStaysWithinTheBound) {
  TwoClocks clocks;
  clocks.out_s = 0.1e-3;
  clocks.back_s = 3.1e-3;
  ClockOffset offset;
  run(clocks, offset, 120, [&](const ClockReading& reading) {
    EXPECT_LE(std::abs(error_s(reading, clocks)), reading.bound_s);
  });
  EXPECT_GT(std::abs(error_s(*offset.at(clocks.now), clocks)), 1e-3);
}

TEST(ClockOffset, ClocksThatAreSetAreFollowedAfterThreeAnswers) {
  for (const double step_s : {30.0, -30.0, 0.02, -3e8}) {
    TwoClocks clocks;
    clocks.loss = 0.0;
    ClockOffset offset;
    run(clocks, offset, 60, [](const ClockReading&) {});
    clocks.offset_s += step_s;
    for (int i = 0; i < 3; ++i) {
      clocks.now += milliseconds(100);
      const ClockVerdict verdict = offset.add(*clocks.exchange());
      EXPECT_EQ(verdict, i < 2 ? ClockVerdict::kContradicts : ClockVerdict::kStepped);
    }
    EXPECT_LE(std::abs(error_s(*offset.at(clocks.now), clocks)), offset.at(clocks.now)->bound_s);
    run(clocks, offset, 60, [&](const ClockReading& reading) {
      EXPECT_LE(std::abs(error_s(reading, clocks)), reading.bound_s);
    });
    EXPECT_LT(std::abs(error_s(*offset.at(clocks.now), clocks)), 300e-6);
    EXPECT_EQ(offset.count(ClockVerdict::kStepped), 1U);
  }
}

TEST(ClockOffset, RobotsClockThatIsSetBackIsFollowedToo) {
  TwoClocks clocks;
  ClockOffset offset;
  run(clocks, offset, 60, [](const ClockReading&) {});
  clocks.now -= seconds(40);  // the server's clock goes on: its offset grows by as much
  clocks.offset_s += 40.0;
  run(clocks, offset, 30, [](const ClockReading&) {});
  EXPECT_EQ(offset.count(ClockVerdict::kStepped), 1U);
  EXPECT_LE(std::abs(error_s(*offset.at(clocks.now), clocks)), offset.at(clocks.now)->bound_s);
}

TEST(ClockOffset, OneLyingAnswerChangesNothing) {
  TwoClocks clocks;
  clocks.loss = 0.0;
  ClockOffset offset;
  run(clocks, offset, 30, [](const ClockReading&) {});
  const nanoseconds before = offset.at(clocks.now)->offset;
  ClockExchange lie = *clocks.exchange();
  lie.server_received += seconds(1);
  lie.server_sent += seconds(1);
  EXPECT_EQ(offset.add(lie), ClockVerdict::kContradicts);
  EXPECT_EQ(offset.at(clocks.now)->offset, before);
  run(clocks, offset, 1, [](const ClockReading&) {});
  EXPECT_EQ(offset.count(ClockVerdict::kStepped), 0U);
}

TEST(ClockOffset, SilenceWidensTheUncertainty) {
  TwoClocks clocks;
  ClockOffset offset;
  run(clocks, offset, 60, [](const ClockReading&) {});
  const ClockReading fresh = *offset.at(clocks.now);
  clocks.now += seconds(600);
  const ClockReading old = *offset.at(clocks.now);
  EXPECT_GT(old.sigma_s, 2.0 * fresh.sigma_s);
  EXPECT_GT(old.bound_s, fresh.bound_s);
  EXPECT_LE(std::abs(error_s(old, clocks)), old.bound_s);
  run(clocks, offset, 5, [&](const ClockReading& reading) {
    EXPECT_LE(std::abs(error_s(reading, clocks)), reading.bound_s);
  });
}

TEST(ClockOffset, ServerStampsComeToTheRobotsClockAndBack) {
  TwoClocks clocks;
  ClockOffset offset;
  run(clocks, offset, 60, [](const ClockReading&) {});
  const Timestamp server = clocks.now + offset.at(clocks.now)->offset;
  EXPECT_NEAR(to_seconds(*offset.robot_time(server) - clocks.now), 0.0, 1e-8);
}

TEST(ClockOffset, ImpossibleAndSlowAnswersAreRefused) {
  ClockOffset offset;
  const auto at = [](std::int64_t ms) { return Timestamp(milliseconds(ms)); };
  EXPECT_EQ(offset.add({at(0), at(1), at(2), at(3)}), ClockVerdict::kImpossible);
  EXPECT_EQ(offset.add({at(1), at(1), at(2), at(-3)}), ClockVerdict::kImpossible);
  EXPECT_EQ(offset.add({at(10), at(20), at(21), at(9)}), ClockVerdict::kImpossible);
  EXPECT_EQ(offset.add({at(10), at(20), at(19), at(12)}), ClockVerdict::kImpossible);
  EXPECT_EQ(offset.add({at(10), at(20), at(29), at(12)}), ClockVerdict::kImpossible);
  EXPECT_EQ(offset.add({at(10), at(20), at(21), at(900)}), ClockVerdict::kTooSlow);
  EXPECT_EQ(offset.count(ClockVerdict::kImpossible), 5U);
  EXPECT_FALSE(offset.at(at(1)));
}

}  // namespace
}  // namespace nadir::fusion
