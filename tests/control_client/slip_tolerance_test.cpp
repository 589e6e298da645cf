// How stiff the inner loop may be with wheels that slip.

#include "control_client/slip_tolerance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "control_client/inner_loop.h"
#include "control_client/simulation/encoders.h"
#include "control_client/simulation/plant.h"

namespace nadir::control_client {
namespace {

const RobotModel& robot() {
  static const RobotModel model{RobotParameters{}};
  return model;
}

ControlParameters tolerating(double slip_s) {
  ControlParameters control;
  control.tolerated_slip_s = slip_s;
  return tolerating_slip(robot(), control);
}

/// Drives at 0.3 m/s for 2 s with wheels whose slip time is `slip_s`; returns the largest
/// departure of the true speed from 0.3 m/s in the last half of a second.
double swing_mps(const ControlParameters& control, double slip_s) {
  EncoderParameters wheels;
  wheels.scale_deviation = 0.0;
  wheels.slip_mean_s = slip_s;
  wheels.slip_deviation_s = 0.0;
  wheels.white_mps = 0.001;
  Encoders encoders(wheels, robot().wheel_count(), 7);
  Plant plant(robot(), Eigen::Vector3d::Zero());
  InnerLoop loop(robot(), control.inner);
  const double step_s = control.inner_step_s();
  constexpr double kSpeed_mps = 0.3;
  Eigen::Vector3d measured = Eigen::Vector3d::Zero();
  double swing = 0.0;
  for (double time_s = 0.0; time_s < 2.0; time_s += step_s) {
    plant.advance(loop.voltages_v({kSpeed_mps, 0.0, 0.0}, measured, step_s), step_s);
    measured =
        robot()
            .geometry()
            .body_rates(encoders.measured_rim_speeds_mps(plant.mean_rim_speeds_mps(), step_s))
            .vector();
    if (time_s > 1.5) swing = std::max(swing, std::abs(plant.body_rates().x() - kSpeed_mps));
  }
  return swing;
}

TEST(SlipTolerance, HalfOfTheGainThatIsStable) {
  // d = 6.7162 1/s (theory 1): 2 0.9 wn = 6.7162 + 0.5 / 0.08 s.
  EXPECT_NEAR(tolerating(0.08).inner.natural_frequency_radps, 7.203, 1e-3);
  EXPECT_EQ(tolerating(0.08).inner.damping, 0.9);
  EXPECT_EQ(tolerating(0.08).outer.natural_frequency_radps, 4.0);
}

TEST(SlipTolerance, MuchSlipIsLimitedByTheIntegralGain) {
  // 0.5 2 0.9 / 0.3 s; the proportional gain would allow 4.66 rad/s.
  EXPECT_NEAR(tolerating(0.3).inner.natural_frequency_radps, 3.0, 1e-12);
}

TEST(SlipTolerance, NeverStifferThanTheRobotsParameters) {
  EXPECT_EQ(tolerating(0.0).inner.natural_frequency_radps, 20.0);
  EXPECT_EQ(tolerating(1e-4).inner.natural_frequency_radps, 20.0);
}

TEST(SlipTolerance, StandsTheSlipAndStaysWithoutIt) {
  EXPECT_LT(swing_mps(tolerating(0.08), 0.0), 0.005);
  EXPECT_LT(swing_mps(tolerating(0.08), 0.05), 0.005);
  EXPECT_LT(swing_mps(tolerating(0.08), -0.08), 0.01);
}

TEST(SlipTolerance, TheStiffLoopSwingsBeyondTheLimitOfTheFormula) {
  const ControlParameters stiff = tolerating(0.0);
  // a22 - d = 36 - 6.7162: unstable below -0.0341 s; the discrete loop a little earlier.
  EXPECT_LT(swing_mps(stiff, -0.02), 0.01);
  EXPECT_GT(swing_mps(stiff, -0.045), 0.05);
}

}  // namespace
}  // namespace nadir::control_client
