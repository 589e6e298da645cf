// Gains, closed-loop poles and limits of the two loops.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <numbers>

#include "control_client/control_loop.h"
#include "control_client/inner_loop.h"
#include "control_client/outer_loop.h"

namespace nadir::control_client {
namespace {

const ControlParameters kControl;

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// States: integral of the error, error. Every pole must be -zeta wn +- j wn sqrt(1 - zeta^2).
void expect_poles(const Eigen::Matrix3d& integral, const Eigen::Matrix3d& proportional,
                  const LoopParameters& loop) {
  Matrix6d a = Matrix6d::Zero();
  a.topRightCorner<3, 3>().setIdentity();
  a.bottomLeftCorner<3, 3>() = -integral;
  a.bottomRightCorner<3, 3>() = -proportional;
  const double real = -loop.damping * loop.natural_frequency_radps;
  const double imaginary =
      loop.natural_frequency_radps * std::sqrt(1.0 - loop.damping * loop.damping);
  for (const std::complex<double>& pole : a.eigenvalues()) {
    EXPECT_NEAR(pole.real(), real, 1e-9);
    EXPECT_NEAR(std::abs(pole.imag()), imaginary, 1e-9);
  }
}

NominalMotion some_motion(double heading_rad) {
  NominalMotion nominal;
  nominal.pose = {0.4, -0.1, heading_rad};
  nominal.velocity_per_s = {0.5, -0.2, 1.3};
  return nominal;
}

TEST(OuterLoop, HasTheAssignedPolesWhereverTheNominalMotionIs) {
  const OuterLoop loop(kControl.outer);
  for (const double heading_rad : {0.0, 1.1, -2.7, 9.0}) {
    const NominalMotion nominal = some_motion(heading_rad);
    const Eigen::Vector3d q = nominal.body_rates();
    const Eigen::Matrix3d b1 = rotation_world_body(heading_rad);
    Eigen::Matrix3d a1 = Eigen::Matrix3d::Zero();
    a1(0, 2) = -std::sin(heading_rad) * q.x() - std::cos(heading_rad) * q.y();
    a1(1, 2) = std::cos(heading_rad) * q.x() - std::sin(heading_rad) * q.y();
    expect_poles(b1 * loop.integral_gain(nominal), b1 * loop.proportional_gain(nominal) - a1,
                 kControl.outer);
  }
}

TEST(OuterLoop, OnTheNominalMotionItAsksForNothingElse) {
  OuterLoop loop(kControl.outer);
  const NominalMotion nominal = some_motion(2.0);
  const fusion::PlanarPose there{0.4, -0.1, 2.0};
  EXPECT_LT((loop.body_rate_command(nominal, there, 0.02) - nominal.body_rates()).norm(), 1e-15);
}

TEST(OuterLoop, TurnsTheShortWayAcrossPi) {
  OuterLoop loop(kControl.outer);
  NominalMotion nominal;
  nominal.pose.z() = 7.0 * std::numbers::pi + 0.05;  // unwrapped, a little beyond pi
  const fusion::PlanarPose pose{0.0, 0.0, std::numbers::pi - 0.05};
  const double turn_radps = loop.body_rate_command(nominal, pose, 0.02, false).z();
  EXPECT_NEAR(turn_radps, kControl.outer.proportional_gain_per_s() * 0.1, 1e-9);
}

TEST(OuterLoop, KeepsItsIntegralWhenToldSo) {
  OuterLoop loop(kControl.outer);
  const NominalMotion nominal;
  const fusion::PlanarPose off{0.1, 0.0, 0.0};
  const Eigen::Vector3d first = loop.body_rate_command(nominal, off, 0.02, false);
  EXPECT_EQ(loop.body_rate_command(nominal, off, 0.02, false), first);
  // The error of this tick counts for the time since the tick before, in this tick's rates.
  const Eigen::Vector3d second = loop.body_rate_command(nominal, off, 0.02, true);
  EXPECT_NEAR(first.x() - second.x(), kControl.outer.integral_gain_per_s2() * 0.02 * 0.1, 1e-12);
  EXPECT_EQ(loop.body_rate_command(nominal, off, 0.02, false), second);
}

TEST(InnerLoop, HasTheAssignedPolesAtAnyBodyRates) {
  const RobotModel model{RobotParameters{}};
  const InnerLoop loop(model, kControl.inner);
  for (const Eigen::Vector3d& q :
       {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(1.0, -0.5, 8.0)}) {
    expect_poles(model.input() * loop.integral_gain(),
                 model.input() * loop.proportional_gain(q) - model.linearization_per_s(q),
                 kControl.inner);
  }
}

TEST(InnerLoop, HoldsTheRatesOfAConstantCommand) {
  const RobotModel model{RobotParameters{}};
  InnerLoop loop(model, kControl.inner);
  const Eigen::Vector3d command(0.2, -0.1, 1.0);
  WheelVector voltages_v;
  for (int i = 0; i < 400; ++i) voltages_v = loop.voltages_v(command, loop.nominal_rates(), 0.005);
  const WheelVector expected_v = model.voltages_v(command, Eigen::Vector3d::Zero());
  // The filter has settled; the measurement of the step before is the nominal one.
  EXPECT_LT((voltages_v - expected_v).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_FALSE(loop.is_saturated());
}

TEST(InnerLoop, LimitsTheVoltagesAndDoesNotWindUp) {
  const RobotModel model{RobotParameters{}};
  InnerLoop loop(model, kControl.inner);
  const double limit_v = model.parameters().motor.max_voltage_v;
  // Blocked: the robot does not move whatever the motors do.
  for (int i = 0; i < 1000; ++i) {
    const WheelVector v = loop.voltages_v({1.0, 0.0, 0.0}, Eigen::Vector3d::Zero(), 0.005);
    EXPECT_LE(v.cwiseAbs().maxCoeff(), limit_v);
  }
  EXPECT_TRUE(loop.is_saturated());
  EXPECT_GT(loop.demanded_voltage_v(), limit_v);
  // Free again: within some steps no motor is at its limit. A wound-up integral of 5 s m/s would
  // ask for thousands of volts for seconds.
  for (int i = 0; i < 60; ++i)
    loop.voltages_v(Eigen::Vector3d::Zero(), loop.nominal_rates(), 0.005);
  EXPECT_FALSE(loop.is_saturated());
}

TEST(ControlLoop, ClipsTheBodyRatesToTheRobotsLimits) {
  const RobotModel model{RobotParameters{}};
  ControlLoop loop(model, kControl, {}, step_trajectory({50.0, -50.0, 3.0}, 2.0));
  fusion::PlanarPose far{-10.0, 10.0, -3.0};
  const Eigen::Vector3d command = loop.tick(far);
  EXPECT_DOUBLE_EQ(command.x(), model.parameters().max_speed_mps);
  EXPECT_DOUBLE_EQ(command.y(), -model.parameters().max_speed_mps);
  EXPECT_LE(std::abs(command.z()), model.parameters().max_turn_rate_radps);
}

}  // namespace
}  // namespace nadir::control_client
