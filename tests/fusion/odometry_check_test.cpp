#include "fusion/odometry_check.h"

#include <gtest/gtest.h>

#include <limits>

namespace nadir::fusion {
namespace {

using namespace std::chrono_literals;

const OdometryCheck kCheck;

TEST(OdometryCheck, RefusesWhatCannotBe) {
  const BodyRates rates{0.2, 0.0, 0.1};
  EXPECT_FALSE(reason_to_refuse(1s, 1s + 5ms, rates, kCheck));
  EXPECT_EQ(reason_to_refuse(0s, 5ms, rates, kCheck), OdometryVerdict::kZeroStamp);
  EXPECT_EQ(reason_to_refuse(-5ms, 5ms, rates, kCheck), OdometryVerdict::kZeroStamp);
  EXPECT_EQ(reason_to_refuse(1s, 1s, rates, kCheck), OdometryVerdict::kEmpty);
  EXPECT_EQ(reason_to_refuse(1s, 1s - 5ms, rates, kCheck), OdometryVerdict::kEmpty);
  EXPECT_EQ(reason_to_refuse(1s, 2s, rates, kCheck), OdometryVerdict::kTooLong);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const BodyRates& bad : {BodyRates{nan, 0, 0}, BodyRates{0, nan, 0}, BodyRates{0, 0, nan},
                               BodyRates{1e9, 0, 0}, BodyRates{0, 0, -1e9}}) {
    EXPECT_EQ(reason_to_refuse(1s, 1s + 5ms, bad, kCheck), OdometryVerdict::kNotFinite);
  }
}

TEST(OdometryClock, JoinsSmallGapsAndOverlaps) {
  OdometryClock clock;
  EXPECT_EQ(clock.compare(10s, 10s, 10s + 5ms, kCheck), OdometryVerdict::kUsed);
  EXPECT_EQ(clock.compare(10s, 10s + 2ms, 10s + 7ms, kCheck), OdometryVerdict::kUsed);
  EXPECT_EQ(clock.compare(10s, 10s - 2ms, 10s + 3ms, kCheck), OdometryVerdict::kUsed);
  EXPECT_EQ(clock.compare(10s, 10s + 3ms, 10s + 8ms, kCheck), OdometryVerdict::kUsedAfterGap);
  EXPECT_EQ(clock.compare(10s, 40s, 40s + 5ms, kCheck), OdometryVerdict::kUsedAfterGap);
}

TEST(OdometryClock, RefusesASampleOffTheKnownTime) {
  OdometryClock clock;
  EXPECT_EQ(clock.compare(10s, 9s, 9s + 5ms, kCheck), OdometryVerdict::kBehind);
  EXPECT_EQ(clock.compare(10s, 100s, 100s + 5ms, kCheck), OdometryVerdict::kAhead);
  EXPECT_EQ(clock.compare(10s, 10s, 10s + 5ms, kCheck), OdometryVerdict::kUsed);
}

TEST(OdometryClock, NoticesThatItWasSet) {
  for (const Timestamp begin : {Timestamp(3s), Timestamp(1000s)}) {
    OdometryClock clock;
    for (int i = 0; i < 9; ++i) {
      const OdometryVerdict verdict =
          clock.compare(10s, begin + i * 5ms, begin + (i + 1) * 5ms, kCheck);
      EXPECT_FALSE(is_used(verdict)) << i;
    }
    EXPECT_EQ(clock.compare(10s, begin + 45ms, begin + 50ms, kCheck),
              OdometryVerdict::kClockRestarted);
    EXPECT_EQ(clock.run_began(), begin);
  }
}

TEST(OdometryClock, IsNotFooledByScatteredStamps) {
  OdometryClock clock;
  for (int i = 0; i < 100; ++i) {
    const Timestamp from = Timestamp(5s) - i * 5ms;  // each before the last
    EXPECT_EQ(clock.compare(10s, from, from + 5ms, kCheck), OdometryVerdict::kBehind);
  }
}

}  // namespace
}  // namespace nadir::fusion
