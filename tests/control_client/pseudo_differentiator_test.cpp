#include "control_client/pseudo_differentiator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

namespace nadir::control_client {
namespace {

TEST(PseudoDifferentiator, StepsByTheMatrixExponential) {
  const double zeta = 0.7;
  for (const double w : {8.0, 40.0}) {
    const double dt_s = 0.02;
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();  // states x, x' and the held command
    a.row(0) << 0.0, 1.0, 0.0;
    a.row(1) << -w * w, -2.0 * zeta * w, w * w;
    const Eigen::Matrix3d transition = (a * dt_s).exp();
    PseudoDifferentiator filter(zeta, w, {0.2, -1.0, 0.0});
    Eigen::Vector3d expected(0.2, 0.0, 0.0);
    for (int i = 0; i < 50; ++i) {
      const double command = std::sin(0.3 * i);
      filter.step(Eigen::Vector3d::Constant(command), dt_s);
      expected = transition * Eigen::Vector3d(expected.x(), expected.y(), command);
      EXPECT_NEAR(filter.value().x(), expected.x(), 1e-12);
      EXPECT_NEAR(filter.rate_per_s().x(), expected.y(), 1e-10);
    }
  }
}

TEST(PseudoDifferentiator, FollowsARampTwoZetaOverWLate) {
  PseudoDifferentiator filter(0.7, 8.0, Eigen::Vector3d::Zero());
  EXPECT_DOUBLE_EQ(filter.ramp_lag_s(), 0.175);
  const double dt_s = 0.001;
  double time_s = 0.0;
  for (; time_s < 5.0; time_s += dt_s) {
    // Held over the step: the middle of the step's ramp.
    filter.step(Eigen::Vector3d::Constant(0.2 * (time_s + 0.5 * dt_s)), dt_s);
  }
  EXPECT_NEAR(filter.value().x(), 0.2 * (time_s - filter.ramp_lag_s()), 1e-7);
  EXPECT_NEAR(filter.rate_per_s().x(), 0.2, 1e-5);  // the command is a staircase: order (w dt)^2
}

TEST(PseudoDifferentiator, RestsAtItsCommand) {
  PseudoDifferentiator filter(0.7, 40.0, {1.0, 2.0, 3.0});
  filter.step({1.0, 2.0, 3.0}, 0.02);
  EXPECT_LT((filter.value() - Eigen::Vector3d(1.0, 2.0, 3.0)).norm(), 1e-15);
  EXPECT_LT(filter.rate_per_s().norm(), 1e-13);
}

// With moving eigenvalues (-zeta +- j s) w(t), s = sqrt(1 - zeta^2), and W the integral of w, the
// free response from rest at 1 is exp(-zeta W) (cos(s W) + zeta/s sin(s W)).
TEST(VaryingPseudoDifferentiator, HasTheAssignedSpectrumWhileItsBandwidthMoves) {
  const double zeta = 0.7;
  const double s = std::sqrt(1.0 - zeta * zeta);
  VaryingPseudoDifferentiator filter(zeta, 2.0, Eigen::Vector3d::Ones());
  const double dt_s = 0.001;
  double bandwidth_integral = 0.0;
  double largest = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double rate = i % 1000 < 500 ? 12.0 : -12.0;  // from 2 to 8 rad/s and back, twice
    bandwidth_integral += filter.bandwidth_radps() * dt_s + 0.5 * rate * dt_s * dt_s;
    filter.step(Eigen::Vector3d::Zero(), rate, dt_s);
    const double expected =
        std::exp(-zeta * bandwidth_integral) *
        (std::cos(s * bandwidth_integral) + zeta / s * std::sin(s * bandwidth_integral));
    largest = std::max(largest, std::abs(filter.value().y() - expected));
  }
  EXPECT_LT(largest, 1e-8);
  EXPECT_NEAR(filter.bandwidth_radps(), 2.0, 1e-9);
}

TEST(VaryingPseudoDifferentiator, IsTheConstantOneWhenItsBandwidthStays) {
  VaryingPseudoDifferentiator varying(0.7, 8.0, {0.1, 0.0, -1.0});
  PseudoDifferentiator constant(0.7, 8.0, {0.1, 0.0, -1.0});
  for (int i = 0; i < 1000; ++i) {
    varying.step({1.0, 0.5, 1.0}, 0.0, 0.001);
    constant.step({1.0, 0.5, 1.0}, 0.001);
  }
  EXPECT_LT((varying.value() - constant.value()).norm(), 1e-11);
  EXPECT_LT((varying.rate_per_s() - constant.rate_per_s()).norm(), 1e-10);
}

}  // namespace
}  // namespace nadir::control_client
