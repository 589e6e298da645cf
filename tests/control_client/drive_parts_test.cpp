// The parts of the onboard process, one by one: time, clocks, odometry, frames.

#include <gtest/gtest.h>

#include <cmath>

#include "control_client/drive/arrival_clock.h"
#include "control_client/drive/client_clock.h"
#include "control_client/drive/frame_gaps.h"
#include "control_client/drive/odometry_merger.h"
#include "control_client/drive/state_announcer.h"
#include "control_client/drive/tick_scheduler.h"
#include "control_client/drive/tracker_clocks.h"

namespace nadir::control_client {
namespace {

using fusion::Timestamp;
using namespace std::chrono_literals;

TEST(TickScheduler, KeepsItsGridHoweverLateItWakes) {
  TickScheduler scheduler(1s, 20ms);
  EXPECT_EQ(scheduler.arrive(1s + 3ms), 1);
  EXPECT_EQ(scheduler.next(), 1s + 20ms);
  EXPECT_EQ(scheduler.arrive(1s + 39ms), 1);
  EXPECT_EQ(scheduler.next(), 1s + 40ms);
}

TEST(TickScheduler, SleptPeriodsAreCountedAndNotMadeUpFor) {
  TickScheduler scheduler(0s, 20ms);
  EXPECT_EQ(scheduler.arrive(0s), 1);
  EXPECT_EQ(scheduler.arrive(105ms), 5);  // those of 20, 40, 60, 80 and 100 ms
  EXPECT_EQ(scheduler.next(), 120ms);
  EXPECT_EQ(scheduler.arrive(106ms), 0);
}

TEST(ClientClock, IsWrongByWhatItWasTold) {
  const ClientClock clock({.offset_s = 3.5, .drift_ppm = 100.0});
  const Timestamp steady = ClientClock::steady_now();
  const Timestamp later = steady + 1000s;
  const Timestamp time = clock.at(later);
  EXPECT_NEAR(fusion::to_seconds(time - clock.at(steady)), 1000.1, 1e-6);
  EXPECT_NEAR(fusion::to_seconds(time - clock.true_wall(time)), 3.6, 1e-4);
  EXPECT_NEAR(
      fusion::to_seconds(clock.true_wall(clock.now()) - Timestamp(tracker::system_clock_ns())), 0.0,
      0.1);
}

tracker::ClockExchange exchange(std::uint64_t epoch, Timestamp robot, Timestamp ahead) {
  return {.epoch = epoch,
          .sequence = 1,
          .t1_ns = robot.count(),
          .t2_ns = (robot + ahead + 100us).count(),
          .t3_ns = (robot + ahead + 110us).count(),
          .t4_ns = (robot + 210us).count()};
}

TEST(TrackerClocks, EachTrackerHasItsOwn) {
  TrackerClocks clocks;
  EXPECT_FALSE(clocks.robot_time(1, 5'000'000'000).has_value());
  EXPECT_FALSE(clocks.add(exchange(1, 10s, 4s)));
  EXPECT_FALSE(clocks.add(exchange(2, 10s, -2s)));
  EXPECT_FALSE(clocks.robot_time(3, 5'000'000'000).has_value());
  EXPECT_NEAR(fusion::to_seconds(clocks.robot_time(1, Timestamp(14s).count()).value()), 10.0, 1e-4);
  EXPECT_NEAR(fusion::to_seconds(clocks.robot_time(2, Timestamp(8s).count()).value()), 10.0, 1e-4);
}

TEST(TrackerClocks, OfManyTheOldestIsForgotten) {
  TrackerClocks clocks;
  for (std::uint64_t epoch = 1; epoch <= 5; ++epoch) clocks.add(exchange(epoch, 10s, 4s));
  EXPECT_FALSE(clocks.robot_time(1, Timestamp(14s).count()).has_value());
  EXPECT_TRUE(clocks.robot_time(5, Timestamp(14s).count()).has_value());
}

TEST(TrackerClocks, AClockThatWasSetIsNotTrustedUntilItsNewTimeIsSure) {
  TrackerClocks clocks;
  for (int i = 0; i < 20; ++i) clocks.add(exchange(1, 10s + i * 200ms, 4s));
  bool jumped = clocks.add(exchange(1, 14s, 9s));
  EXPECT_FALSE(jumped);
  EXPECT_FALSE(clocks.robot_time(1, Timestamp(23s).count()).has_value());
  for (int i = 1; i < 8 && !jumped; ++i) jumped = clocks.add(exchange(1, 14s + i * 200ms, 9s));
  EXPECT_TRUE(jumped);
  EXPECT_NEAR(fusion::to_seconds(clocks.robot_time(1, Timestamp(24s).count()).value()), 15.0, 1e-3);
}

TEST(OdometryMerger, JoinsWhatFollowsToTheirMean) {
  OdometryMerger merger;
  EXPECT_FALSE(merger.add({0ms, 5ms, {1.0, 0.0, 2.0}}).has_value());
  EXPECT_FALSE(merger.add({5ms, 20ms, {5.0, 4.0, -2.0}}).has_value());
  const OdometryInterval joined = merger.take().value();
  EXPECT_EQ(joined.from, 0ms);
  EXPECT_EQ(joined.to, 20ms);
  EXPECT_DOUBLE_EQ(joined.mean_rates.u_mps, 4.0);
  EXPECT_DOUBLE_EQ(joined.mean_rates.v_mps, 3.0);
  EXPECT_DOUBLE_EQ(joined.mean_rates.r_radps, -1.0);
  EXPECT_FALSE(merger.take().has_value());
}

TEST(OdometryMerger, AGapIsNotFilled) {
  OdometryMerger merger;
  merger.add({0ms, 5ms, {1.0, 0.0, 0.0}});
  const OdometryInterval before = merger.add({10ms, 15ms, {2.0, 0.0, 0.0}}).value();
  EXPECT_EQ(before.to, 5ms);
  EXPECT_EQ(merger.take().value().from, 10ms);
}

TEST(FrameGaps, CountsWhatDidNotComeInAnyOrder) {
  FrameGaps gaps;
  for (const std::uint64_t frame : {10U, 12U, 11U, 15U, 14U}) gaps.add(1, 1, frame);
  EXPECT_EQ(gaps.lost(), 1U);
  gaps.add(1, 2, 3);  // the tracker was restarted
  gaps.add(1, 2, 6);
  EXPECT_EQ(gaps.lost(), 3U);
  for (std::uint32_t camera = 2; camera < 20; ++camera) gaps.add(camera, 1, 0);
  EXPECT_EQ(gaps.lost(), 3U) << "cameras that are forgotten keep their losses";
}

TEST(ArrivalClock, TheFastestArrivalTellsTheDifference) {
  ArrivalClock clock;
  EXPECT_EQ(clock.arrived(100s, 107s + 3ms), 7s + 3ms);
  EXPECT_EQ(clock.arrived(100s + 5ms, 107s + 5ms), 7s);
  EXPECT_EQ(clock.arrived(100s + 10ms, 107s + 40ms), 7s) << "this one waited";
}

TEST(ArrivalClock, FollowsAClockThatWasSet) {
  ArrivalClock clock;
  clock.arrived(100s, 107s);
  EXPECT_EQ(clock.arrived(200s, 107s + 5ms), -(93s - 5ms)) << "ahead: at once";
  clock.arrived(100s + 10ms, 107s + 10ms);
  Timestamp shift{};
  for (int i = 3; i < 200; ++i) {
    const Timestamp passed = i * 5ms;
    shift = clock.arrived(100s + passed, 107s + passed);
  }
  EXPECT_EQ(shift, 7s) << "back: when it lasts";
}

TEST(StateAnnouncer, SpeaksOfChangesAndNotTooOften) {
  StateAnnouncer announcer("blue 3");
  SafetyVerdict verdict;
  verdict.reason = tracker::ClientReason::kNoOdometry;
  EXPECT_EQ(announcer.line(verdict, 10s).value(), "blue 3: starting (no odometry)");
  EXPECT_FALSE(announcer.line(verdict, 11s).has_value());
  verdict = {tracker::ClientMode::kDriving, tracker::ClientReason::kNone, 1.0};
  EXPECT_EQ(announcer.line(verdict, 12s).value(), "blue 3: driving");
  verdict.mode = tracker::ClientMode::kSlow;
  verdict.reason = tracker::ClientReason::kPoseTooOld;
  EXPECT_FALSE(announcer.line(verdict, 12s + 100ms).has_value());
  EXPECT_EQ(announcer.line(verdict, 12s + 600ms).value(), "blue 3: slow (pose too old)");
}

}  // namespace
}  // namespace nadir::control_client
