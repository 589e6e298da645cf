// Where simulated robots were between the moments at which they said so.

#include "tracker/truth_history.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace nadir::tracker {
namespace {

using std::chrono::milliseconds;

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
constexpr std::int64_t kTick_ns = 5'000'000;
constexpr milliseconds kHold{500};

/// A circle of 0.3 m at 1 m/s, the heading turning the other way past +-pi.
constexpr double kRadius_m = 0.3;
constexpr double kRate_radps = 1.0 / kRadius_m;
constexpr double kTurn_radps = -7.0;

WireSimulatedTruth on_circle(std::int64_t time_ns) {
  const double t_s = 1e-9 * static_cast<double>(time_ns - kStart_ns);
  const double angle = kRate_radps * t_s;
  WireSimulatedTruth truth;
  truth.team = "blue";
  truth.robot = 3;
  truth.epoch = 1;
  truth.time_ns = time_ns;
  truth.pose_world_robot = {kRadius_m * std::cos(angle), kRadius_m * std::sin(angle),
                            fusion::wrap_angle(kTurn_radps * t_s)};
  truth.velocity_x_mps = -std::sin(angle);
  truth.velocity_y_mps = std::cos(angle);
  truth.heading_rate_radps = kTurn_radps;
  return truth;
}

TruthHistory circle_of(int ticks) {
  TruthHistory history;
  for (int k = 0; k < ticks; ++k) history.add(on_circle(kStart_ns + k * kTick_ns));
  return history;
}

TEST(TruthHistory, BetweenSamplesIsTheCircleToNanometres) {
  const TruthHistory history = circle_of(400);
  for (std::int64_t time_ns = kStart_ns + 1; time_ns < kStart_ns + 399 * kTick_ns;
       time_ns += 1'234'567) {
    const auto motion = history.at(time_ns, kHold);
    ASSERT_TRUE(motion.has_value());
    const WireSimulatedTruth truth = on_circle(time_ns);
    EXPECT_NEAR(motion->x_m, truth.pose_world_robot.x_m, 1e-9);
    EXPECT_NEAR(motion->y_m, truth.pose_world_robot.y_m, 1e-9);
    EXPECT_NEAR(fusion::wrap_angle(motion->heading_rad - truth.pose_world_robot.heading_rad), 0.0,
                1e-9);
    EXPECT_NEAR(motion->velocity_x_mps, truth.velocity_x_mps, 1e-5);
    EXPECT_NEAR(motion->velocity_y_mps, truth.velocity_y_mps, 1e-5);
    EXPECT_NEAR(motion->heading_rate_radps, kTurn_radps, 1e-6);
  }
}

TEST(TruthHistory, SamplesInAnyOrderAreTheSame) {
  TruthHistory shuffled;
  for (const int k : {3, 0, 4, 1, 2, 2}) shuffled.add(on_circle(kStart_ns + k * kTick_ns));
  const TruthHistory ordered = circle_of(5);
  for (std::int64_t time_ns = kStart_ns; time_ns < kStart_ns + 4 * kTick_ns; time_ns += 333'333) {
    EXPECT_EQ(shuffled.at(time_ns, kHold)->x_m, ordered.at(time_ns, kHold)->x_m);
  }
}

TEST(TruthHistory, AfterTheNewestItGoesStraightOnThenRestsThenIsGone) {
  const TruthHistory history = circle_of(3);
  const std::int64_t last_ns = kStart_ns + 2 * kTick_ns;
  const WireSimulatedTruth last = on_circle(last_ns);
  const auto soon = history.at(last_ns + 10'000'000, kHold);
  ASSERT_TRUE(soon.has_value());
  EXPECT_NEAR(soon->x_m, last.pose_world_robot.x_m + 0.01 * last.velocity_x_mps, 1e-12);
  EXPECT_EQ(soon->velocity_y_mps, last.velocity_y_mps);
  const auto later = history.at(last_ns + 400'000'000, kHold);
  ASSERT_TRUE(later.has_value());
  EXPECT_NEAR(later->y_m, last.pose_world_robot.y_m + 0.05 * last.velocity_y_mps, 1e-12);
  EXPECT_EQ(later->velocity_y_mps, 0.0);
  EXPECT_TRUE(history.at(last_ns + 500'000'000, kHold).has_value());
  EXPECT_FALSE(history.at(last_ns + 500'000'001, kHold).has_value());
}

TEST(TruthHistory, BeforeTheFirstAndInALongGapThereIsNoRobot) {
  TruthHistory history = circle_of(3);
  const std::int64_t again_ns = kStart_ns + 1'500'000'000;
  history.add(on_circle(again_ns));
  EXPECT_FALSE(history.at(kStart_ns - 1, kHold).has_value());
  EXPECT_TRUE(history.at(kStart_ns, kHold).has_value());
  EXPECT_FALSE(history.at(kStart_ns + 1'000'000'000, kHold).has_value());
  EXPECT_TRUE(history.at(again_ns, kHold).has_value());
}

TEST(TruthHistory, ForgetsWhatIsOldAndAnotherRun) {
  TruthHistory history;
  EXPECT_FALSE(history.newest_ns().has_value());
  EXPECT_FALSE(history.at(kStart_ns, kHold).has_value());
  history = circle_of(1000);  // 5 s
  EXPECT_FALSE(history.at(kStart_ns + 2'900'000'000, kHold).has_value());
  EXPECT_TRUE(history.at(kStart_ns + 3'100'000'000, kHold).has_value());
  WireSimulatedTruth restarted = on_circle(kStart_ns + 6'000'000'000);
  restarted.epoch = 2;
  history.add(restarted);
  EXPECT_FALSE(history.at(kStart_ns + 4'900'000'000, kHold).has_value());
  EXPECT_EQ(history.newest_ns(), restarted.time_ns);
}

}  // namespace
}  // namespace nadir::tracker
