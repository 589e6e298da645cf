#include "control_client/differential/tracking_gains.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

#include "control_client/differential/riccati.h"

namespace nadir::control_client {
namespace {

TEST(TrackingGains, AreThoseOfThePaper) {
  const TrackingGains gains = closed_form_gains({.ahead = 1.0, .side = 50.0}, 0.1);
  TrackingGains printed;
  printed << 1.0, 0.0, 0.0, 0.0, 7.0711, 1.1892;
  EXPECT_LT((gains - printed).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_NEAR(closed_form_gains({}, 0.2)(1, 2), 1.6818, 1e-4);
  EXPECT_NEAR(closed_form_gains({}, 1.0)(1, 2), 3.7606, 1e-4);
}

TEST(TrackingGains, ClosedFormSolvesTheRiccatiEquation) {
  for (const double speed_mps : {0.02, 0.1, 0.4, 1.5}) {
    for (const TrackingWeights& weights :
         {TrackingWeights{}, TrackingWeights{4.0, 5.0, 0.0}, TrackingWeights{1.0, 500.0, 2.0}}) {
      const TrackingGains by_hand = closed_form_gains(weights, speed_mps);
      EXPECT_LT((riccati_gains(weights, speed_mps, 0.0) - by_hand).cwiseAbs().maxCoeff(), 1e-6);
    }
  }
}

TEST(TrackingGains, SampledOnesApproachThemAsThePeriodShrinks) {
  TrackingGains at_20_ms;
  at_20_ms << 0.990, 0.0, 0.0, 0.0, 6.988, 1.182;
  EXPECT_LT((sampled_riccati_gains({}, 0.1, 0.0, 0.02) - at_20_ms).cwiseAbs().maxCoeff(), 1e-3);
  const TrackingGains limit = closed_form_gains({}, 0.1);
  EXPECT_LT((sampled_riccati_gains({}, 0.1, 0.0, 1e-6) - limit).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(TrackingGains, AreCoupledWhereTheReferenceTurns) {
  TrackingGains coupled;
  coupled << 1.709, -5.610, -0.569, -0.569, 4.036, 0.695;
  EXPECT_LT((riccati_gains({}, 0.1, 0.2) - coupled).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Riccati, SolutionsSatisfyTheirEquationsAndStabilise) {
  Eigen::MatrixXd a(3, 3);
  a << 0.3, 1.0, 0.0, -0.4, 0.2, 0.7, 0.1, 0.0, -0.5;
  Eigen::MatrixXd b(3, 1);
  b << 0.0, 1.0, 0.3;
  const Eigen::MatrixXd q = Eigen::Vector3d(2.0, 0.0, 1.0).asDiagonal();
  const Eigen::MatrixXd r = Eigen::MatrixXd::Constant(1, 1, 0.5);

  const Eigen::MatrixXd x = solve_continuous_riccati(a, b, q, r);
  const Eigen::MatrixXd gain = r.inverse() * b.transpose() * x;
  EXPECT_LT((a.transpose() * x + x * a - x * b * gain + q).norm(), 1e-9 * x.norm());
  EXPECT_LT(Eigen::MatrixXd(a - b * gain).eigenvalues().real().maxCoeff(), -1e-3);

  const Eigen::MatrixXd y = solve_discrete_riccati(a, b, q, r);
  const Eigen::MatrixXd steps = (r + b.transpose() * y * b).inverse() * (b.transpose() * y * a);
  EXPECT_LT((a.transpose() * y * (a - b * steps) + q - y).norm(), 1e-9 * y.norm());
  EXPECT_LT(Eigen::MatrixXd(a - b * steps).eigenvalues().cwiseAbs().maxCoeff(), 1.0 - 1e-3);
}

TEST(Riccati, ASystemThatCannotBeStabilisedIsRefused) {
  const Eigen::MatrixXd grows = Eigen::Vector2d(1.5, -0.5).asDiagonal();
  Eigen::MatrixXd b(2, 1);
  b << 0.0, 1.0;  // does not reach what grows
  const Eigen::MatrixXd q = Eigen::MatrixXd::Identity(2, 2);
  const Eigen::MatrixXd r = Eigen::MatrixXd::Identity(1, 1);
  EXPECT_THROW(solve_continuous_riccati(grows, b, q, r), std::invalid_argument);
  EXPECT_THROW(solve_discrete_riccati(grows, b, q, r), std::invalid_argument);
}

TEST(Riccati, SampledSystemIsTheExactOne) {
  Eigen::MatrixXd a(2, 2);
  a << 0.0, 1.0, 0.0, -2.0;
  Eigen::MatrixXd b(2, 1);
  b << 0.0, 1.0;
  const SampledSystem system = sampled(a, b, 0.3);
  const double e = std::exp(-0.6);
  EXPECT_NEAR(system.a(0, 1), 0.5 * (1.0 - e), 1e-12);
  EXPECT_NEAR(system.a(1, 1), e, 1e-12);
  EXPECT_NEAR(system.b(0, 0), 0.5 * (0.3 - 0.5 * (1.0 - e)), 1e-12);
  EXPECT_NEAR(system.b(1, 0), 0.5 * (1.0 - e), 1e-12);
}

}  // namespace
}  // namespace nadir::control_client
