#include "fusion/pose_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "tests/fusion/random_stream.h"
#include "tests/fusion/rate_bias_model.h"
#include "tests/fusion/textbook_filter.h"

namespace nadir::fusion {
namespace {

using test::RandomStream;
using test::RateBiasModel;

constexpr double kPi = std::numbers::pi;

Eigen::Matrix3d diagonal(double x, double y, double heading) {
  return Eigen::Vector3d(x, y, heading).asDiagonal();
}

PoseCovariance random_covariance(RandomStream& random) {
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i) = random.normal();
  const Eigen::Matrix3d scale = diagonal(2e-3, 2e-3, 3e-2);
  return scale * (root * root.transpose() + 0.1 * Eigen::Matrix3d::Identity()) * scale;
}

TEST(PoseFilter, AgreesWithTheTextbookOverThousandsOfSteps) {
  const Eigen::Matrix3d q = diagonal(6e-4, 6e-4, 6e-2);
  PoseFilter<>::Settings settings;
  settings.odometry_error = WhiteOdometryNoise(q, 0.005);
  settings.recovery.poses = 0;
  PoseFilter<> filter(settings);
  const PoseCovariance start = diagonal(1e-6, 1e-6, 1e-4);
  filter.start({0.1, -0.2, 3.0}, start);
  test::TextbookFilter textbook(Eigen::Vector3d(0.1, -0.2, 3.0), start);
  RandomStream random(6);
  for (int k = 1; k < 20000; ++k) {
    const BodyRates rates{0.3 * std::sin(0.01 * k), 0.2 * std::cos(0.013 * k), 0.4};
    filter.predict({rates, rates, 0.005, 0.005});
    textbook.predict(rates.vector(), q, 0.005);
    if (k % 8 == 0) {
      const PoseCovariance r = random_covariance(random);
      const Eigen::Vector3d z = textbook.x() + 1.5 * random.normal(r);
      filter.correct({z.x(), z.y(), z.z()}, r);
      textbook.correct(z, r);
    }
    const auto& x = textbook.x();
    // The textbook's chord is as long as the arc: (r dt)^2 / 24 of it too long.
    ASSERT_LT(pose_difference(filter.state().pose, {x[0], x[1], x[2]}).norm(), 1e-7) << k;
    ASSERT_LT((filter.state().covariance - textbook.p()).norm(), 1e-5 * textbook.p().norm()) << k;
  }
}

TEST(PoseFilter, CorrectionIsTheSumOfTheInformation) {
  RandomStream random(7);
  for (int run = 0; run < 100; ++run) {
    PoseFilter<> filter;
    const PoseCovariance p = random_covariance(random);
    const PoseCovariance r = random_covariance(random);
    filter.start({1.0, 2.0, 0.5}, p);
    const Eigen::Vector3d e = random.normal(p + r);
    const Correction result = filter.correct({1.0 + e[0], 2.0 + e[1], 0.5 + e[2]}, r);
    if (!is_used(result.verdict)) continue;
    const Eigen::Matrix3d expected = (p.inverse() + r.inverse()).inverse();
    const Eigen::Vector3d change = expected * r.inverse() * e;
    EXPECT_LT((filter.state().covariance - expected).norm(), 1e-10 * expected.norm());
    EXPECT_LT((pose_difference(filter.state().pose, {1.0, 2.0, 0.5}) - change).norm(), 1e-12);
    EXPECT_NEAR(result.nis, e.dot((p + r).inverse() * e), 1e-9);
  }
}

TEST(PoseFilter, CorrelationsOfTheMeasuredPoseMoveWhatTheyShould) {
  // Heading known, y measured together with the heading: the heading's surprise moves y.
  PoseFilter<> filter;
  filter.start({0.0, 0.0, 0.0}, diagonal(1e-4, 1e-4, 1e-8));
  PoseCovariance r = diagonal(1e-6, 1e-6, 1e-4);
  r(1, 2) = r(2, 1) = -0.5e-5;
  filter.correct({0.0, 0.0, 0.01}, r);
  EXPECT_NEAR(filter.state().pose.y_m, 0.5e-3, 2e-5);
}

TEST(PoseFilter, InnovationOfTheHeadingIsWrapped) {
  PoseFilter<> filter;
  filter.start({0.0, 0.0, kPi - 0.01}, diagonal(1e-6, 1e-6, 1e-3));
  const Correction result = filter.correct({0.0, 0.0, -kPi + 0.01}, diagonal(1e-6, 1e-6, 1e-3));
  EXPECT_EQ(result.verdict, PoseVerdict::kAccepted);
  EXPECT_NEAR(result.innovation.z(), 0.02, 1e-15);
  EXPECT_NEAR(std::abs(filter.state().pose.heading_rad), kPi, 1e-12);
}

TEST(PoseFilter, CovarianceOfASplitStepAddsUp) {
  for (const double heading_rad : {0.0, 1.0}) {
    PoseFilter<> whole;
    PoseFilter<> parts;
    const BodyRates rates{0.2, 0.1, 0.5};
    whole.start({0.0, 0.0, heading_rad}, diagonal(1e-6, 1e-6, 1e-4));
    parts.set_state(whole.state());
    whole.predict({rates, rates, 0.02, 0.02});
    parts.predict({rates, rates, 0.02, 0.013});
    parts.predict({rates, rates, 0.02, 0.007});
    EXPECT_LT(pose_difference(whole.state().pose, parts.state().pose).norm(), 1e-16);
    EXPECT_LT((whole.state().covariance - parts.state().covariance).norm(),
              1e-5 * whole.state().covariance.norm());
  }
}

TEST(PoseFilter, TransitionIsTheDerivativeOfTheStep) {
  PoseFilter<AboutEstimate, RateBiasModel> filter;
  RandomStream random(8);
  for (int run = 0; run < 50; ++run) {
    filter.start({0.1, 0.2, random.uniform(-2.0, 2.0)}, diagonal(1e-6, 1e-6, 1e-4));
    auto at = filter.state();
    at.odometry_error = {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1),
                         random.uniform(-1.0, 1.0)};
    const BodyRates rates{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-9, 9)};
    const OdometryStep step{rates, rates, 0.05, 0.04};
    const auto after = [&](Eigen::Matrix<double, 6, 1> change) {
      auto state = at;
      state.pose.x_m += change[0];
      state.pose.y_m += change[1];
      state.pose.heading_rad += change[2];
      state.odometry_error += change.tail<3>();
      filter.set_state(state);
      filter.predict(step);
      return filter.state();
    };
    filter.set_state(at);
    const auto f = filter.predict(step);
    for (int i = 0; i < 6; ++i) {
      constexpr double kStep = 1e-6;
      Eigen::Matrix<double, 6, 1> change = Eigen::Matrix<double, 6, 1>::Zero();
      change[i] = kStep;
      const auto plus = after(change);
      const auto minus = after(-change);
      Eigen::Matrix<double, 6, 1> slope;
      slope << pose_difference(plus.pose, minus.pose), plus.odometry_error - minus.odometry_error;
      slope /= 2.0 * kStep;
      EXPECT_LT((f.col(i) - slope).norm(), 1e-8) << i;
    }
  }
}

TEST(PoseFilter, AlongTheNominalOnlyTheCovarianceDependsOnTheNominal) {
  PoseFilter<AlongNominal> nominal;
  PoseFilter<AboutEstimate> estimate;
  const BodyRates rates{0.2, -0.1, 0.7};
  nominal.start({0.0, 0.0, 0.3}, diagonal(1e-6, 1e-6, 1e-2));
  estimate.start({0.0, 0.0, 0.3}, diagonal(1e-6, 1e-6, 1e-2));
  const OdometryStep step{rates, rates, 0.02, 0.02};
  const Eigen::Matrix3d same = nominal.predict(step, {0.3, rates});
  EXPECT_EQ(same, estimate.predict(step));
  EXPECT_EQ(nominal.state().covariance, estimate.state().covariance);

  const BodyRates planned{0.5, 0.0, 0.0};
  const Eigen::Matrix3d other = nominal.predict(step, {1.0, planned});
  estimate.predict(step);
  EXPECT_EQ(nominal.state().pose.x_m, estimate.state().pose.x_m);
  EXPECT_EQ(nominal.state().pose.y_m, estimate.state().pose.y_m);
  // A13 = -T (sin(psi) u + cos(psi) v), A23 = T (cos(psi) u - sin(psi) v) with nominal values.
  EXPECT_NEAR(other(0, 2), -0.02 * 0.5 * std::sin(1.0), 1e-15);
  EXPECT_NEAR(other(1, 2), 0.02 * 0.5 * std::cos(1.0), 1e-15);
}

TEST(PoseFilter, BelievesTheFifthConsistentPoseBeyondTheGate) {
  PoseFilter<> filter;
  const PoseCovariance r = diagonal(1e-6, 1e-6, 1e-4);
  filter.start({0.0, 0.0, 0.0}, r);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(filter.correct({0.05, 0.0, 0.0}, r).verdict, PoseVerdict::kGated);
  }
  EXPECT_EQ(filter.state().pose.x_m, 0.0);
  EXPECT_EQ(filter.correct({0.05, 0.0, 0.0}, r).verdict, PoseVerdict::kRecovered);
  EXPECT_NEAR(filter.state().pose.x_m, 0.05, 1e-4);
  EXPECT_LT(filter.state().covariance(0, 0), 1.01e-6);
  EXPECT_EQ(filter.correct({0.05, 0.0, 0.0}, r).verdict, PoseVerdict::kAccepted);
}

TEST(PoseFilter, StartsAnewWhereItWasCarried) {
  PoseFilter<> filter;
  const PoseCovariance r = diagonal(1e-6, 1e-6, 1e-4);
  filter.start({0.0, 0.0, 0.0}, r);
  for (int i = 0; i < 4; ++i) filter.correct({1.0, 0.5, 2.0}, r);
  EXPECT_EQ(filter.correct({1.0, 0.5, 2.0}, r).verdict, PoseVerdict::kReset);
  EXPECT_EQ(filter.state().pose.x_m, 1.0);
  EXPECT_EQ(filter.state().pose.heading_rad, 2.0);
  EXPECT_EQ(filter.state().covariance, r);
}

TEST(PoseFilter, ACarriedRobotThatDrivesOnIsBelievedToo) {
  // Turned by half a turn it drives away from where odometry thinks; the poses agree with each
  // other all the same.
  PoseFilter<> filter;
  const PoseCovariance r = diagonal(1e-6, 1e-6, 1e-4);
  const BodyRates rates{0.5, 0.0, 0.0};
  filter.start({0.0, 0.0, 0.0}, r);
  PlanarPose truth{0.6, 0.4, kPi};
  PoseVerdict last = PoseVerdict::kGated;
  for (int i = 0; i < 5; ++i) {
    truth = moved(truth, rates, 0.04);
    filter.predict({rates, rates, 0.04, 0.04});
    last = filter.correct(truth, r).verdict;
  }
  EXPECT_EQ(last, PoseVerdict::kReset);
}

TEST(PoseFilter, WithoutRecoveryItStaysLockedOut) {
  PoseFilter<>::Settings settings;
  settings.recovery.poses = 0;
  PoseFilter<> filter(settings);
  const PoseCovariance r = diagonal(1e-6, 1e-6, 1e-4);
  filter.start({0.0, 0.0, 0.0}, r);
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(filter.correct({0.05, 0.0, 0.0}, r).verdict, PoseVerdict::kGated);
  }
}

TEST(PoseFilter, RefusedPosesChangeNothing) {
  PoseFilter<> filter;
  filter.start({0.0, 0.0, 0.0}, diagonal(1e-6, 1e-6, 1e-4));
  const Correction result = filter.correct({0.0, 0.0, 0.0}, diagonal(1e-6, -1e-6, 1e-4));
  EXPECT_EQ(result.verdict, PoseVerdict::kCovarianceNotPositive);
  EXPECT_EQ(filter.state().covariance, diagonal(1e-6, 1e-6, 1e-4));
}

TEST(PoseFilter, PosesOfAnUnstartedFilterAreNotMoved) {
  PoseFilter<> filter;
  EXPECT_EQ(filter.predict({{1, 0, 0}, {1, 0, 0}, 0.1, 0.1}), Eigen::Matrix3d::Identity());
  EXPECT_FALSE(filter.state().has_started);
  EXPECT_EQ(filter.correct({1, 2, 7.0}, diagonal(1e-6, 1e-6, 1e-4)).verdict, PoseVerdict::kStarted);
  EXPECT_NEAR(filter.state().pose.heading_rad, 7.0 - 2.0 * kPi, 1e-15);
}

TEST(PoseFilter, GrowsUnsureInAGap) {
  PoseFilter<> filter;
  filter.start({0.0, 0.0, 0.0}, diagonal(1e-6, 1e-6, 1e-4));
  const auto start = filter.state();
  filter.predict_gap({0.4, 0.0, 0.0}, 0.05);
  EXPECT_NEAR(filter.state().pose.x_m, 0.02, 1e-15) << "a short gap: the robot goes on";
  EXPECT_GT(filter.state().covariance(0, 0), 1e-6 + std::pow(3.0 * 0.05 * 0.05, 2));
  filter.set_state(start);
  filter.predict_gap({0.4, 0.0, 0.0}, 30.0);
  EXPECT_EQ(filter.state().pose.x_m, 0.0) << "a long one: it is somewhere around";
  EXPECT_GT(filter.state().covariance(0, 0), 900.0);
  EXPECT_LT(filter.state().covariance(2, 2), 20.0);
}

}  // namespace
}  // namespace nadir::fusion
