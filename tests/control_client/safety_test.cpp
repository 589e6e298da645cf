// What stops a robot, what slows it down, and what lets it go on.

#include "control_client/drive/safety.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace nadir::control_client {
namespace {

using tracker::ClientMode;
using tracker::ClientReason;

constexpr double kTick_s = 0.02;

SafetyView fine() {
  SafetyView view;
  view.clock_known = true;
  view.odometry_age_s = 0.005;
  view.pose_age_s = 0.08;
  view.position_sigma_m = 0.001;
  view.heading_sigma_rad = 0.01;
  view.command_gap_s = 0.005;
  return view;
}

/// The last verdict after this view for some time.
SafetyVerdict after(Safety& safety, const SafetyView& view, double time_s) {
  SafetyVerdict verdict;
  for (double t = 0.0; t < time_s; t += kTick_s) verdict = safety.update(view, kTick_s);
  return verdict;
}

TEST(Safety, StartsOnlyWithOdometryClockAndPose) {
  Safety safety({});
  SafetyView view;
  EXPECT_EQ(after(safety, view, 1.0).reason, ClientReason::kNoOdometry);
  view.odometry_age_s = 0.01;
  EXPECT_EQ(after(safety, view, 1.0).reason, ClientReason::kNoClock);
  view.clock_known = true;
  EXPECT_EQ(after(safety, view, 1.0).reason, ClientReason::kNoPose);
  EXPECT_EQ(safety.verdict().mode, ClientMode::kStarting);
  EXPECT_FALSE(safety.verdict().drives());
  view.pose_age_s = 0.08;
  const SafetyVerdict verdict = safety.update(view, kTick_s);
  EXPECT_EQ(verdict.mode, ClientMode::kDriving);
  EXPECT_EQ(verdict.pace, 1.0);
}

struct Blocker {
  const char* name;
  std::function<void(SafetyView&)> happen;
  ClientMode mode;
  ClientReason reason;
};

class SafetyStops : public testing::TestWithParam<Blocker> {};

TEST_P(SafetyStops, AtOnceAndGoesOnWhenAllHasBeenFineForAWhile) {
  const SafetySettings settings;
  Safety safety(settings);
  after(safety, fine(), 1.0);
  SafetyView view = fine();
  GetParam().happen(view);
  const SafetyVerdict stopped = safety.update(view, kTick_s);
  EXPECT_EQ(stopped.mode, GetParam().mode);
  EXPECT_EQ(stopped.reason, GetParam().reason);
  EXPECT_FALSE(stopped.drives());
  EXPECT_FALSE(after(safety, fine(), settings.resume_after_s - 2.0 * kTick_s).drives());
  EXPECT_EQ(safety.verdict().reason, GetParam().reason) << "the reason stays while it stands";
  EXPECT_EQ(after(safety, fine(), 3.0 * kTick_s).mode, ClientMode::kDriving);
}

INSTANTIATE_TEST_SUITE_P(
    Reasons, SafetyStops,
    testing::Values(Blocker{"EmergencyStop", [](SafetyView& v) { v.emergency_stop = true; },
                            ClientMode::kEmergency, ClientReason::kEmergencyStop},
                    Blocker{"Interrupted", [](SafetyView& v) { v.interrupted = true; },
                            ClientMode::kStopped, ClientReason::kInterrupted},
                    Blocker{"NoOdometry", [](SafetyView& v) { v.odometry_age_s = 0.3; },
                            ClientMode::kStopped, ClientReason::kNoOdometry},
                    Blocker{"ClockJump", [](SafetyView& v) { v.clock_jumped = true; },
                            ClientMode::kStopped, ClientReason::kClockJump},
                    Blocker{"OldPose", [](SafetyView& v) { v.pose_age_s = 1.6; },
                            ClientMode::kStopped, ClientReason::kPoseTooOld},
                    Blocker{"Uncertain", [](SafetyView& v) { v.position_sigma_m = 0.11; },
                            ClientMode::kStopped, ClientReason::kUncertain},
                    Blocker{"UncertainHeading", [](SafetyView& v) { v.heading_sigma_rad = 0.6; },
                            ClientMode::kStopped, ClientReason::kUncertain},
                    Blocker{"OffTrack", [](SafetyView& v) { v.off_track_m = 0.31; },
                            ClientMode::kStopped, ClientReason::kOffTrack},
                    Blocker{"CommandGap", [](SafetyView& v) { v.command_gap_s = 0.15; },
                            ClientMode::kStopped, ClientReason::kOther}),
    [](const auto& test) { return test.param.name; });

struct Doubt {
  const char* name;
  std::function<void(SafetyView&, double)> set;
  SafetyLimit limit;
  ClientReason reason;
};

class SafetySlowsDown : public testing::TestWithParam<Doubt> {};

TEST_P(SafetySlowsDown, BeyondTheLimitAndUntilWellBelowIt) {
  const SafetySettings settings;
  Safety safety(settings);
  after(safety, fine(), 1.0);
  const auto at = [&](double value) {
    SafetyView view = fine();
    GetParam().set(view, value);
    return safety.update(view, kTick_s);
  };
  const double slow = GetParam().limit.slow;
  EXPECT_EQ(at(0.99 * slow).mode, ClientMode::kDriving);
  const SafetyVerdict verdict = at(1.01 * slow);
  EXPECT_EQ(verdict.mode, ClientMode::kSlow);
  EXPECT_EQ(verdict.reason, GetParam().reason);
  EXPECT_EQ(verdict.pace, settings.slow_pace);
  EXPECT_EQ(at(0.9 * slow).mode, ClientMode::kSlow) << "no flicker";
  EXPECT_EQ(at(0.75 * slow).mode, ClientMode::kDriving);
}

const SafetySettings kDefaults;
INSTANTIATE_TEST_SUITE_P(
    Quantities, SafetySlowsDown,
    testing::Values(Doubt{"PoseAge", [](SafetyView& v, double x) { v.pose_age_s = x; },
                          SafetySettings{}.pose_age_s, ClientReason::kPoseTooOld},
                    Doubt{"Position", [](SafetyView& v, double x) { v.position_sigma_m = x; },
                          SafetySettings{}.position_sigma_m, ClientReason::kUncertain},
                    Doubt{"Heading", [](SafetyView& v, double x) { v.heading_sigma_rad = x; },
                          SafetySettings{}.heading_sigma_rad, ClientReason::kUncertain},
                    Doubt{"OffTrack", [](SafetyView& v, double x) { v.off_track_m = x; },
                          SafetySettings{}.off_track_m, ClientReason::kOffTrack},
                    Doubt{"Turned", [](SafetyView& v, double x) { v.off_track_rad = x; },
                          SafetySettings{}.off_track_rad, ClientReason::kOffTrack},
                    Doubt{"Saturated", [](SafetyView& v, double x) { v.saturated_share = x; },
                          SafetySettings{}.saturated_share, ClientReason::kSaturated}),
    [](const auto& test) { return test.param.name; });

TEST(Safety, TheMostUrgentReasonIsTold) {
  Safety safety({});
  after(safety, fine(), 1.0);
  SafetyView view = fine();
  view.emergency_stop = true;
  view.odometry_age_s = 1.0;
  view.pose_age_s = 9.0;
  EXPECT_EQ(safety.update(view, kTick_s).reason, ClientReason::kEmergencyStop);
  view.emergency_stop = false;
  EXPECT_EQ(safety.update(view, kTick_s).reason, ClientReason::kNoOdometry);
  view.odometry_age_s = 0.0;
  EXPECT_EQ(safety.update(view, kTick_s).reason, ClientReason::kPoseTooOld);
}

TEST(Safety, AtTheEndOfTheTrajectoryTheRobotHoldsItsPlace) {
  Safety safety({});
  SafetyView view = fine();
  view.trajectory_over = true;
  const SafetyVerdict verdict = after(safety, view, 0.1);
  EXPECT_EQ(verdict.mode, ClientMode::kFinished);
  EXPECT_TRUE(verdict.drives());
  view.emergency_stop = true;
  EXPECT_FALSE(safety.update(view, kTick_s).drives());
}

}  // namespace
}  // namespace nadir::control_client
