#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "control_client/differential/differential_cases.h"
#include "control_client/path_trajectories.h"

namespace nadir::control_client {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kRuns = 20;

DifferentialSummary summary_of(const std::vector<DifferentialCase>& cases, const char* name) {
  for (const DifferentialCase& each : cases) {
    if (each.name == name) return run_case(each, 0, kRuns).summary;
  }
  ADD_FAILURE() << "no case " << name;
  return {};
}

double degrees(double rad) { return rad * 180.0 / kPi; }

TEST(Unicycle, MovesOnAnArcAsSmallStepsDo) {
  const UnicycleMotion motion{0.3, -1.7};
  const fusion::PlanarPose start{0.2, -0.1, 2.9};
  const fusion::PlanarPose end = moved(start, motion, 0.8);
  constexpr int kSteps = 200000;
  double x = start.x_m;
  double y = start.y_m;
  for (int i = 0; i < kSteps; ++i) {
    const double heading = start.heading_rad + motion.turn_rate_radps * 0.8 * (i + 0.5) / kSteps;
    x += motion.speed_mps * std::cos(heading) * 0.8 / kSteps;
    y += motion.speed_mps * std::sin(heading) * 0.8 / kSteps;
  }
  EXPECT_NEAR(end.x_m, x, 1e-9);
  EXPECT_NEAR(end.y_m, y, 1e-9);
  EXPECT_NEAR(end.heading_rad, 2.9 - 1.7 * 0.8, 1e-12);
  const UnicycleMotion back = motion_of(wheel_speeds(motion, 0.23), 0.23);
  EXPECT_NEAR(back.speed_mps, motion.speed_mps, 1e-15);
  EXPECT_NEAR(back.turn_rate_radps, motion.turn_rate_radps, 1e-14);
}

TEST(Unicycle, ReferenceLooksWhereThePathGoesOrTheOtherWay) {
  TrajectoryPoint point;
  point.pose = {1.0, 2.0, 0.0};
  point.velocity_per_s = {0.0, 0.2, 0.0};
  point.acceleration_per_s2 = {-0.1, 0.0, 0.0};
  const UnicycleReference forward = reference_along(point, false, 0.0);
  EXPECT_NEAR(forward.pose.heading_rad, kPi / 2.0, 1e-12);
  EXPECT_NEAR(forward.motion.speed_mps, 0.2, 1e-12);
  EXPECT_NEAR(forward.motion.turn_rate_radps, 0.5, 1e-12);
  const UnicycleReference backward = reference_along(point, true, 0.0);
  EXPECT_NEAR(backward.pose.heading_rad, -kPi / 2.0, 1e-12);
  EXPECT_NEAR(backward.motion.speed_mps, -0.2, 1e-12);
  EXPECT_NEAR(backward.motion.turn_rate_radps, 0.5, 1e-12);
  const UnicycleReference standing = reference_along({{1.0, 2.0, 0.0}, {}, {}}, false, 0.7);
  EXPECT_EQ(standing.pose.heading_rad, 0.7);
  EXPECT_EQ(standing.motion.speed_mps, 0.0);
}

TEST(Unicycle, ErrorIsAsTheRobotSeesIt) {
  UnicycleReference reference;
  reference.pose = {1.0, 1.0, -3.0};
  const Eigen::Vector3d error = tracking_error(reference, {1.0, 0.5, kPi / 2.0});
  EXPECT_NEAR(error.x(), 0.5, 1e-12);  // ahead
  EXPECT_NEAR(error.y(), 0.0, 1e-12);
  EXPECT_NEAR(error.z(), 1.5 * kPi - 3.0, 1e-12);  // the short way round
}

TEST(UnicycleLimits, KeepTheArcOrCutEachRate) {
  const UnicycleMotion cut = limited({0.8, -0.4}, {0.4, 0.8, false});
  EXPECT_EQ(cut.speed_mps, 0.4);
  EXPECT_EQ(cut.turn_rate_radps, -0.4);
  const UnicycleMotion arc = limited({0.8, -0.4}, {0.4, 0.8, true});
  EXPECT_NEAR(arc.speed_mps, 0.4, 1e-12);
  EXPECT_NEAR(arc.turn_rate_radps, -0.2, 1e-12);
}

TEST(TrackingController, BothConvergeFromAside) {
  DecentralisedSettings integral;
  integral.integral_ahead_per_s2 = 0.2;
  integral.integral_side = 1.0;
  for (const TrackingController::Settings& settings :
       {TrackingController::Settings(DecentralisedSettings{}),
        TrackingController::Settings(KlancarSettings{}), TrackingController::Settings(integral)}) {
    TrackingController controller(settings, {});
    UnicycleReference reference{{0.0, 0.0, 0.3}, {0.1, 0.0}};
    fusion::PlanarPose pose{-0.1, 0.15, 1.2};
    for (int k = 0; k < 3000; ++k) {
      pose = moved(pose, controller.command(reference, pose, 0.02), 0.02);
      reference.pose = moved(reference.pose, reference.motion, 0.02);
    }
    const Eigen::Vector3d error = tracking_error(reference, pose);
    EXPECT_LT(error.norm(), 1e-4) << settings.index();
  }
}

TEST(PathTrajectories, TurnOnlyInCornersAndEndWhereTheyShould) {
  const TrajectoryPtr shapes = l_shapes_trajectory();
  EXPECT_NEAR(shapes->duration_s(), 60.0, 1e-9);
  EXPECT_LT((shapes->at(20.0).pose - Eigen::Vector3d(2.0, 1.0, kPi / 2.0)).norm(), 1e-9);
  EXPECT_LT((shapes->at(60.0).pose - Eigen::Vector3d(3.5, 3.5, kPi / 2.0)).norm(), 1e-9);
  const TrajectoryPtr circles = s1_circles_trajectory();
  EXPECT_NEAR(circles->duration_s(), 20.0 * kPi, 1e-9);
  EXPECT_LT((circles->at(5.0 * kPi).pose - Eigen::Vector3d(0.5, 1.5, kPi)).norm(), 1e-9);
  EXPECT_LT((circles->at(15.0 * kPi).pose - Eigen::Vector3d(0.5, -0.5, kPi)).norm(), 1e-9);
}

// Table 12.8 of the theory, 20 runs with other random numbers.
TEST(LShapes, AreDrivenAsWellAsTheReferenceSimulationDoes) {
  const std::vector<DifferentialCase> cases = l_shape_cases();
  struct Row {
    const char* name;
    double rms_mm, max_mm, heading_deg;
  };
  for (const Row& row : {Row{"truth", 33.5, 107.0, 0.0}, Row{"filter", 35.0, 112.0, 1.36},
                         Row{"filter-unfelt", 34.9, 112.0, 1.75},
                         Row{"wheels", 930.0, 1780.0, 26.1}, Row{"klancar", 39.4, 113.0, 1.36}}) {
    SCOPED_TRACE(row.name);
    const DifferentialSummary s = summary_of(cases, row.name);
    EXPECT_NEAR(1e3 * s.position_rms_m, row.rms_mm, 0.03 * row.rms_mm);
    EXPECT_NEAR(1e3 * s.position_max_m, row.max_mm, 0.03 * row.max_mm);
    EXPECT_NEAR(degrees(s.heading_rms_rad), row.heading_deg, 0.05 * row.heading_deg + 1e-9);
  }
  EXPECT_LT(degrees(summary_of(cases, "filter").heading_rms_rad), 1.5);
}

TEST(LShapes, HonestNoiseGatesAndACameraBeatThePapersFilter) {
  const std::vector<DifferentialCase> cases = l_shape_cases();
  EXPECT_LT(degrees(summary_of(cases, "matched").heading_rms_rad), 0.8);
  EXPECT_GT(degrees(summary_of(cases, "iron").heading_rms_rad), 10.0);
  EXPECT_LT(degrees(summary_of(cases, "iron-gated").heading_rms_rad), 1.1);
  EXPECT_LT(degrees(summary_of(cases, "vision").heading_rms_rad), 0.4);
}

TEST(TwoCircles, WithoutFeedForwardTheErrorIsWhatTheTheorySays) {
  const std::vector<DifferentialCase> cases = two_circle_cases();
  // e2 = w_r / (k2 + k3 w_r^2 / (k1 v_r))
  const DifferentialSummary feedback = summary_of(cases, "feedback-truth");
  EXPECT_NEAR(1e3 * feedback.side_end_m, 26.5, 0.5);
  EXPECT_NEAR(1e3 * feedback.position_rms_m, 26.1, 0.8);
  EXPECT_LT(1e3 * summary_of(cases, "feed-forward-truth").position_max_m, 2.0);
  EXPECT_NEAR(1e3 * summary_of(cases, "feedback-filter").position_rms_m, 27.5, 1.5);
  EXPECT_LT(1e3 * summary_of(cases, "integral-truth").position_end_m, 0.5);
}

TEST(Square, ALargerWeightToTheSideOvershootsLess) {
  double before_m = 1.0;
  double before_rms_m = 1.0;
  for (const DifferentialCase& each : square_cases()) {
    const DifferentialSummary s = run_case(each, 0, 1).summary;
    EXPECT_LE(s.overshoot_m, before_m) << each.name;
    EXPECT_LT(s.position_rms_m, before_rms_m) << each.name;
    before_m = s.overshoot_m;
    before_rms_m = s.position_rms_m;
  }
}

TEST(DifferentialRun, ASeedIsARun) {
  DifferentialScenario scenario = l_shape_cases()[1].scenario;
  const auto first = run_differential(scenario, 7);
  const auto again = run_differential(scenario, 7);
  const auto other = run_differential(scenario, 8);
  EXPECT_EQ(first.back().truth.x_m, again.back().truth.x_m);
  EXPECT_NE(first.back().truth.x_m, other.back().truth.x_m);
}

}  // namespace
}  // namespace nadir::control_client
