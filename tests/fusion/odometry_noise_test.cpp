#include "fusion/odometry_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "fusion/odometry.h"
#include "fusion/pose_filter.h"
#include "tests/fusion/random_stream.h"

namespace nadir::fusion {
namespace {

/// Errors with the variance of `noise`, over intervals of two lengths.
std::vector<OdometryErrorSample> simulated(const AccelerationNoise& noise, int count,
                                           std::uint64_t seed) {
  test::RandomStream random(seed);
  std::vector<OdometryErrorSample> samples;
  for (int i = 0; i < count; ++i) {
    const double a = random.uniform(0.0, 4.0);
    const double interval_s = i % 2 == 0 ? 0.04 : 0.02;
    const double along = interval_s * (noise.k1_m2ps + noise.k2_m2ps * a * a);
    const double turn = interval_s * (noise.k1_rad2ps + noise.k2_rad2ps * a * a);
    samples.push_back(
        {random.normal(Eigen::Vector3d(along, along, turn).asDiagonal()), a, interval_s});
  }
  return samples;
}

TEST(AccelerationOdometryNoise, GrowsWithTheSquareOfTheAcceleration) {
  const AccelerationNoise noise;
  const AccelerationOdometryNoise model(noise);
  const OdometryStep step{{0.3, 0.1, 0.2}, {0.24, 0.02, 0.1}, 0.04, 0.01};
  const double a = std::hypot(0.06, 0.08) / 0.04;
  EXPECT_NEAR(linear_acceleration_mps2(step), a, 1e-12);
  const auto corrected = model.corrected(step, {});
  EXPECT_NEAR(corrected.white_intensity(0, 0), noise.k1_m2ps + noise.k2_m2ps * a * a, 1e-12);
  EXPECT_NEAR(corrected.white_intensity(1, 1), corrected.white_intensity(0, 0), 1e-18);
  EXPECT_NEAR(corrected.white_intensity(2, 2), noise.k1_rad2ps + noise.k2_rad2ps * a * a, 1e-12);
}

TEST(AccelerationOdometryNoise, IsZeroWhileTheRobotStands) {
  PoseFilter<AboutEstimate, AccelerationOdometryNoise> filter;
  const PoseCovariance start = Eigen::Vector3d(1e-6, 1e-6, 1e-4).asDiagonal();
  filter.start({0.1, 0.2, 0.3}, start);
  for (int k = 0; k < 500; ++k) filter.predict({{}, {}, 0.02, 0.02});
  EXPECT_EQ((filter.state().covariance - start).norm(), 0.0);
  // The interval in which it starts, and that in which it stops, are not standing.
  filter.predict({{}, {0.1, 0.0, 0.0}, 0.02, 0.02});
  EXPECT_GT(filter.state().covariance(0, 0), start(0, 0));
}

TEST(OdometryError, IsOdometryMinusTruthInTheRobotsFrame) {
  const PlanarPose before{1.0, 2.0, 0.8};
  const OdometryStep step{{0.4, -0.1, 1.5}, {0.3, -0.1, 1.5}, 0.04, 0.04};
  const BodyRates truly{0.35, -0.12, 1.4};
  const auto sample = odometry_error(step, before, moved(before, truly, 0.04));
  EXPECT_NEAR(sample.error.x(), 0.04 * 0.05, 1e-4);
  EXPECT_NEAR(sample.error.y(), 0.04 * 0.02, 1e-4);
  EXPECT_NEAR(sample.error.z(), 0.04 * 0.1, 1e-12);
  EXPECT_NEAR(sample.acceleration_mps2, 0.1 / 0.04, 1e-12);
  EXPECT_EQ(odometry_error(step, before, moved(before, step.mean_rates, 0.04)).error.norm(), 0.0);
}

TEST(AccelerationNoiseIdentification, RecoversTheConstantsWithinTheirErrors) {
  AccelerationNoise truth;
  truth.k2_m2ps = 2.0 * truth.k1_m2ps;
  truth.k2_rad2ps = 0.5 * truth.k1_rad2ps;
  int outside = 0;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    const auto found = identify_acceleration_noise(simulated(truth, 2000, seed));
    ASSERT_TRUE(found.has_value());
    const AccelerationNoise& k = found->noise;
    outside += std::abs(k.k1_m2ps - truth.k1_m2ps) > 2.0 * found->sigma_k1_m2ps ? 1 : 0;
    outside += std::abs(k.k2_m2ps - truth.k2_m2ps) > 2.0 * found->sigma_k2_m2ps ? 1 : 0;
    outside += std::abs(k.k1_rad2ps - truth.k1_rad2ps) > 2.0 * found->sigma_k1_rad2ps ? 1 : 0;
    outside += std::abs(k.k2_rad2ps - truth.k2_rad2ps) > 2.0 * found->sigma_k2_rad2ps ? 1 : 0;
    EXPECT_NEAR(k.k1_m2ps, truth.k1_m2ps, 0.3 * truth.k1_m2ps);
    EXPECT_NEAR(k.k2_m2ps, truth.k2_m2ps, 0.2 * truth.k2_m2ps);
    EXPECT_NEAR(k.k2_rad2ps, truth.k2_rad2ps, 0.3 * truth.k2_rad2ps);
    EXPECT_LT(found->sigma_k1_m2ps, 0.2 * truth.k1_m2ps);
  }
  // 4.6 percent of 100 are expected outside of two standard errors.
  EXPECT_LE(outside, 12);
}

TEST(AccelerationNoiseIdentification, NoConstantIsNegative) {
  AccelerationNoise constant;
  constant.k2_m2ps = 0.0;
  constant.k2_rad2ps = 0.0;
  AccelerationNoise only_acceleration;
  only_acceleration.k1_m2ps = 0.0;
  only_acceleration.k1_rad2ps = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const AccelerationNoise& truth : {constant, only_acceleration}) {
      const auto found = identify_acceleration_noise(simulated(truth, 400, seed));
      ASSERT_TRUE(found.has_value());
      EXPECT_GE(found->noise.k1_m2ps, 0.0);
      EXPECT_GE(found->noise.k2_m2ps, 0.0);
      const double expected = truth.k1_m2ps + 4.0 * truth.k2_m2ps;
      EXPECT_NEAR(found->noise.k1_m2ps + 4.0 * found->noise.k2_m2ps, expected, 0.3 * expected);
    }
  }
}

TEST(AccelerationNoiseIdentification, SaysNothingFromNothing) {
  EXPECT_FALSE(identify_acceleration_noise({}).has_value());
  std::vector<OdometryErrorSample> same(50, {Eigen::Vector3d(1e-3, 0.0, 1e-3), 1.0, 0.02});
  EXPECT_FALSE(identify_acceleration_noise(same).has_value());
  same[7].acceleration_mps2 = 2.0;
  EXPECT_TRUE(identify_acceleration_noise(same).has_value());
  same[3].error.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(identify_acceleration_noise(same).has_value());
}

}  // namespace
}  // namespace nadir::fusion
