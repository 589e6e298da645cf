// The simulated robot as a base: it obeys, reports, and stops by itself.

#include "control_client/drive/simulated_base.h"

#include <gtest/gtest.h>

#include <vector>

namespace nadir::control_client {
namespace {

using fusion::Timestamp;
using namespace std::chrono_literals;

class Base : public testing::Test {
 protected:
  static constexpr Timestamp kStart = 100s;

  SimulatedBase base() {
    SimulationSettings settings;
    settings.encoders.kind = EncoderKind::kPerfect;
    return {model_, ControlParameters{}.inner, settings, kStart,
            [this](const TruthSample& truth) { truths_.push_back(truth); }};
  }

  static tracker::WireWheelCommand forward(double speed_mps) {
    tracker::WireWheelCommand command;
    command.kind = tracker::WheelCommandKind::kBodyRates;
    command.valid_for_ns = Timestamp(100ms).count();
    command.body_rates.u_mps = speed_mps;
    return command;
  }

  RobotModel model_{RobotParameters{}};
  std::vector<TruthSample> truths_;
  std::vector<OdometryInterval> odometry_;
};

TEST_F(Base, ReportsEveryStepOfItsGridOnceHoweverLateItIsAsked) {
  SimulatedBase base = this->base();
  base.take_odometry(kStart + 4ms, &odometry_);
  EXPECT_TRUE(odometry_.empty());
  base.take_odometry(kStart + 33ms, &odometry_);
  ASSERT_EQ(odometry_.size(), 6U);
  EXPECT_EQ(odometry_.front().from, kStart);
  EXPECT_EQ(odometry_.back().to, kStart + 30ms);
  ASSERT_EQ(truths_.size(), 6U);
  EXPECT_EQ(truths_.back().time, kStart + 30ms);
  base.take_odometry(kStart + 36ms, &odometry_);
  ASSERT_EQ(odometry_.size(), 1U);
  EXPECT_EQ(odometry_.front().from, kStart + 30ms);
}

TEST_F(Base, FirmwareReachesTheCommandedRates) {
  SimulatedBase base = this->base();
  for (Timestamp time = kStart; time < kStart + 1s; time += 20ms) {
    base.command(forward(0.3), time);
    base.take_odometry(time, &odometry_);
  }
  EXPECT_NEAR(base.plant().body_rates().x(), 0.3, 0.003);
  EXPECT_NEAR(truths_.back().velocity_per_s.x(), 0.3, 0.003);
  EXPECT_FALSE(base.stopped_itself());
}

TEST_F(Base, StopsByItselfWhenACommandIsValidNoLonger) {
  SimulatedBase base = this->base();
  for (Timestamp time = kStart; time < kStart + 1s; time += 20ms) {
    base.command(forward(0.3), time);
    base.take_odometry(time, &odometry_);
  }
  base.take_odometry(kStart + 1070ms, &odometry_);
  EXPECT_FALSE(base.stopped_itself());
  base.take_odometry(kStart + 3s, &odometry_);
  EXPECT_TRUE(base.stopped_itself());
  EXPECT_LT(base.plant().body_rates().norm(), 1e-4);
  base.command(forward(0.3), kStart + 3s);
  base.take_odometry(kStart + 3050ms, &odometry_);
  EXPECT_FALSE(base.stopped_itself());
}

TEST_F(Base, VoltsBeyondTheMotorsRangeAreTheRange) {
  SimulatedBase base = this->base();
  SimulatedBase twin = this->base();
  tracker::WireWheelCommand command = forward(0.0);
  command.kind = tracker::WheelCommandKind::kVolts;
  command.wheels = {{0.0, 60.0, -60.0}, 3};
  base.command(command, kStart);
  command.wheels = {{0.0, 6.0, -6.0}, 3};
  twin.command(command, kStart);
  base.take_odometry(kStart + 90ms, &odometry_);
  twin.take_odometry(kStart + 90ms, &odometry_);
  EXPECT_EQ(base.plant().pose(), twin.plant().pose());
  EXPECT_GT(base.plant().pose().x(), 0.01);
}

TEST_F(Base, TellsTheTruthBetweenItsSteps) {
  SimulatedBase base = this->base();
  for (Timestamp time = kStart; time < kStart + 1s; time += 20ms) {
    base.command(forward(0.3), time);
    base.take_odometry(time, &odometry_);
  }
  const Timestamp end = odometry_.back().to;
  const double before_m = base.truth_at(end)->x_m;
  EXPECT_NEAR(base.truth_at(end + 4ms)->x_m, before_m + 0.3 * 0.004, 1e-5);
}

}  // namespace
}  // namespace nadir::control_client
