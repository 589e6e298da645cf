#include "fusion/wheel_geometry.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "tests/fusion/random_stream.h"

namespace nadir::fusion {
namespace {

constexpr double kBodyRadius_m = 0.07;
constexpr double kDegree = std::numbers::pi / 180.0;

TEST(WheelGeometry, ThreeWheelsHaveADiagonalBTimesBTransposed) {
  const auto rows = WheelGeometry::three_wheel(kBodyRadius_m).rims_by_rates();
  const Eigen::Matrix3d product = rows.transpose() * rows;
  const Eigen::Matrix3d expected =
      Eigen::Vector3d(1.5, 1.5, 3.0 * kBodyRadius_m * kBodyRadius_m).asDiagonal();
  EXPECT_LT((product - expected).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(WheelGeometry, FirstWheelDoesNotFeelForwardMotion) {
  // The misprint of S0 eq 2 (a one where a zero belongs) decodes this as (0.2, 0.133, -0.952).
  const WheelGeometry geometry = WheelGeometry::three_wheel(kBodyRadius_m);
  const WheelValues speeds = geometry.rim_speeds_mps({0.2, 0.0, 0.0});
  EXPECT_EQ(speeds[0], 0.0);
  EXPECT_NEAR(speeds[1], 0.2 * std::cos(30 * kDegree), 1e-16);
  EXPECT_NEAR(speeds[2], -0.2 * std::cos(30 * kDegree), 1e-16);
  const BodyRates back = geometry.body_rates(speeds);
  EXPECT_NEAR(back.u_mps, 0.2, 1e-16);
  EXPECT_NEAR(back.v_mps, 0.0, 1e-16);
  EXPECT_NEAR(back.r_radps, 0.0, 1e-15);
}

TEST(WheelGeometry, ThreeWheelsAgreeWithTheOtherPapersFormulas) {
  // S3 eq 4 numbers the wheels otherwise: V = (V3 - V2)/(2 sin 60), Vn = (2 V1 - V2 - V3)/3,
  // w = (V1 + V2 + V3)/(3 L). Its first wheel drives to the left; S2's first to the right.
  const WheelGeometry geometry = WheelGeometry::three_wheel(kBodyRadius_m);
  const Eigen::Vector3d s3(0.31, -0.12, 0.2);
  const double forward = (s3[2] - s3[1]) / (2.0 * std::sin(60 * kDegree));
  const double left = (2.0 * s3[0] - s3[1] - s3[2]) / 3.0;
  const double turn = s3.sum() / (3.0 * kBodyRadius_m);
  // Turned by half a turn, S3's robot is S2's: forward and left change sign, turning does not.
  const Eigen::Vector3d s2(s3[0], s3[1], s3[2]);
  const BodyRates rates = geometry.body_rates(s2);
  EXPECT_NEAR(rates.u_mps, -forward, 1e-15);
  EXPECT_NEAR(rates.v_mps, -left, 1e-15);
  EXPECT_NEAR(rates.r_radps, turn, 1e-14);
}

TEST(WheelGeometry, BodyRatesComeBackFromRimSpeeds) {
  test::RandomStream random(4);
  const std::array<WheelGeometry, 2> omnis = {
      WheelGeometry::three_wheel(kBodyRadius_m),
      WheelGeometry::four_wheel(Eigen::Vector4d(33, 147, 225, 315) * kDegree, 0.08)};
  for (const WheelGeometry& geometry : omnis) {
    for (int i = 0; i < 100; ++i) {
      const BodyRates rates{random.normal(), random.normal(), 10.0 * random.normal()};
      const BodyRates back = geometry.body_rates(geometry.rim_speeds_mps(rates));
      EXPECT_LT((back.vector() - rates.vector()).norm(), 1e-13);
    }
  }
}

TEST(WheelGeometry, FourWheelsAreSolvedByLeastSquares) {
  const WheelGeometry geometry =
      WheelGeometry::four_wheel(Eigen::Vector4d(45, 135, 225, 315) * kDegree, 0.08);
  WheelValues speeds(4);
  speeds << 0.3, -0.1, 0.25, 0.4;  // no motion of a rigid body
  const Eigen::Vector3d independent =
      Eigen::MatrixXd(geometry.rims_by_rates()).colPivHouseholderQr().solve(speeds);
  EXPECT_LT((geometry.body_rates(speeds).vector() - independent).norm(), 1e-14);
}

TEST(WheelGeometry, DifferentialDriveTurnsOnTheSpot) {
  const WheelGeometry geometry = WheelGeometry::differential(0.2);
  const WheelValues speeds = geometry.rim_speeds_mps({0.0, 0.0, 1.5});
  EXPECT_DOUBLE_EQ(speeds[0], -0.15);
  EXPECT_DOUBLE_EQ(speeds[1], 0.15);
  const BodyRates arc = geometry.body_rates(Eigen::Vector2d(0.1, 0.3));
  EXPECT_DOUBLE_EQ(arc.u_mps, 0.2);
  EXPECT_EQ(arc.v_mps, 0.0);
  EXPECT_DOUBLE_EQ(arc.r_radps, 1.0);
}

TEST(WheelGeometry, RimNoiseBecomesTheCovarianceOfTheClosedForm) {
  const Eigen::Matrix3d covariance =
      WheelGeometry::three_wheel(kBodyRadius_m).rate_covariance(0.03);
  const Eigen::Matrix3d expected =
      Eigen::Vector3d(2.0 / 3.0, 2.0 / 3.0, 1.0 / (3.0 * kBodyRadius_m * kBodyRadius_m))
          .asDiagonal() *
      9e-4;
  EXPECT_LT((covariance - expected).cwiseAbs().maxCoeff(), 1e-16);
}

TEST(WheelGeometry, RefusesWheelsThatCannotHoldTheRobot) {
  const std::array<Wheel, 3> parallel = {Wheel{1, 0, 0.1}, Wheel{1, 0, -0.1}, Wheel{1, 0, 0.2}};
  EXPECT_THROW(WheelGeometry::omni(parallel), std::invalid_argument);
  const std::array<Wheel, 2> two = {};
  EXPECT_THROW(WheelGeometry::omni(two), std::invalid_argument);
  const std::array<Wheel, 7> seven = {};
  EXPECT_THROW(WheelGeometry::omni(seven), std::invalid_argument);
}

TEST(Encoders, CountsBecomeMeanRatesAlsoWhereTheCounterWraps) {
  const WheelGeometry geometry = WheelGeometry::three_wheel(kBodyRadius_m);
  constexpr double kRimPerCount_m = 2.0 * std::numbers::pi * 0.025 / (512 * 14);
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  const Eigen::Vector3i from(0, kMost - 10, -5);
  const Eigen::Vector3i to(-400, std::numeric_limits<std::int32_t>::min() + 289, 295);
  // Travels of -400, 300 and 300 counts: 400/1.5*... to the left, no turn would need a zero sum.
  const BodyRates rates = mean_body_rates(geometry, from, to, kRimPerCount_m, 0.02);
  const BodyRates expected =
      geometry.body_rates(Eigen::Vector3d(-400, 300, 300) * kRimPerCount_m / 0.02);
  EXPECT_LT((rates.vector() - expected.vector()).norm(), 1e-15);
  EXPECT_NEAR(rates.v_mps, (400 + 300) * 2.0 / 3.0 * kRimPerCount_m / 0.02, 1e-15);
}

}  // namespace
}  // namespace nadir::fusion
