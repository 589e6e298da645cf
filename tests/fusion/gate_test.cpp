#include "fusion/gate.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/fusion/random_stream.h"

namespace nadir::fusion {
namespace {

double nis(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& covariance) {
  return innovation.dot(covariance.inverse() * innovation);
}

Eigen::Matrix3d correlated() {
  Eigen::Matrix3d covariance;
  covariance << 4e-6, 1e-6, -3e-6, 1e-6, 1e-6, 2e-6, -3e-6, 2e-6, 1e-4;
  return covariance;
}

TEST(Gate, RectangularLooksAtEachComponentAlone) {
  const Eigen::Matrix3d covariance = Eigen::Vector3d(1.0, 4.0, 9.0).asDiagonal();
  const Gate gate = Gate::rectangular(3.0);
  EXPECT_TRUE(gate.passes({3.0, -6.0, 9.0}, covariance, 27.0));
  EXPECT_FALSE(gate.passes({3.01, 0.0, 0.0}, covariance, 9.06));
  EXPECT_FALSE(gate.passes({0.0, -6.01, 0.0}, covariance, 9.03));
  EXPECT_FALSE(gate.passes({0.0, 0.0, 9.01}, covariance, 9.02));
}

TEST(Gate, ChiSquareLooksAtTheDistanceByTheCovariance) {
  const Gate gate = Gate::chi_square();
  EXPECT_TRUE(gate.passes(Eigen::Vector3d::Zero(), correlated(), 14.15));
  EXPECT_FALSE(gate.passes(Eigen::Vector3d::Zero(), correlated(), 14.16));
}

TEST(Gate, RejectsGoodPosesAsOftenAsItPromises) {
  // 1 - 0.9973^3 = 0.81 % (independent components) and 0.27 %; 4 sigma of 200,000 draws.
  test::RandomStream random(5);
  const Eigen::Matrix3d independent = Eigen::Vector3d(1e-6, 2e-6, 1e-3).asDiagonal();
  constexpr int kDraws = 200000;
  int rectangular = 0;
  int chi_square = 0;
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::Vector3d e = random.normal(independent);
    rectangular += Gate::rectangular().passes(e, independent, nis(e, independent)) ? 0 : 1;
    const Eigen::Vector3d c = random.normal(correlated());
    chi_square += Gate::chi_square().passes(c, correlated(), nis(c, correlated())) ? 0 : 1;
  }
  EXPECT_NEAR(rectangular / double{kDraws}, 0.0081, 0.0008);
  EXPECT_NEAR(chi_square / double{kDraws}, 0.0027, 0.00047);
}

TEST(Gate, LetsNothingThroughThatIsNotANumber) {
  const double nan = std::nan("");
  EXPECT_FALSE(Gate::rectangular().passes({0.0, nan, 0.0}, correlated(), nan));
  EXPECT_FALSE(Gate::chi_square().passes({0.0, nan, 0.0}, correlated(), nan));
}

TEST(RejectedRun, GrowsWhileThePosesSayTheSame) {
  const LockOutRecovery recovery;
  const Eigen::Vector3d variance(1e-6, 1e-6, 1e-4);
  RejectedRun run;
  extend(run, recovery, {0.10, 0.20, 3.14}, variance);
  EXPECT_EQ(run.poses, 1);
  extend(run, recovery, {0.104, 0.197, -3.14}, variance);
  EXPECT_EQ(run.poses, 2) << "headings differ by little across the end of their range";
  extend(run, recovery, {0.104, 0.197, -3.0}, variance);
  EXPECT_EQ(run.poses, 1) << "0.14 rad is more than 4 sqrt(2) 0.01 + 0.02";
}

TEST(RejectedRun, StartsAnewWithAPoseElsewhere) {
  const LockOutRecovery recovery;
  const Eigen::Vector3d variance(1e-6, 1e-6, 1e-4);
  RejectedRun run;
  for (int i = 0; i < 4; ++i) extend(run, recovery, {0.1, 0.2, 0.0}, variance);
  EXPECT_EQ(run.poses, 4);
  // The limit is 4 sqrt(2e-6) + 0.004 = 9.66 mm.
  extend(run, recovery, {0.1097, 0.2, 0.0}, variance);
  EXPECT_EQ(run.poses, 1);
  extend(run, recovery, {0.1097, 0.2096, 0.0}, variance);
  EXPECT_EQ(run.poses, 2);
}

}  // namespace
}  // namespace nadir::fusion
