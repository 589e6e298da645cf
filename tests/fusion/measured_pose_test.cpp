#include "fusion/measured_pose.h"

#include <gtest/gtest.h>

#include <limits>

namespace nadir::fusion {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

PoseCovariance good_covariance() {
  PoseCovariance covariance;
  covariance << 2e-6, -3e-7, 1e-6, -3e-7, 2e-6, -2e-6, 1e-6, -2e-6, 1e-4;
  return covariance;
}

PoseCovariance with(int row, int column, double value) {
  PoseCovariance covariance = good_covariance();
  covariance(row, column) = value;
  if (row != column) covariance(column, row) = value;
  return covariance;
}

TEST(MeasuredPose, GoodOnesAreNotRefused) {
  EXPECT_FALSE(reason_to_refuse({0.1, 0.2, 0.3}, good_covariance()));
  EXPECT_FALSE(reason_to_refuse({0.1, 0.2, 9.0}, good_covariance()));  // heading will be wrapped
}

TEST(MeasuredPose, RefusesWhatIsNotFinite) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    EXPECT_EQ(reason_to_refuse({bad, 0, 0}, good_covariance()), PoseVerdict::kNotFinite);
    EXPECT_EQ(reason_to_refuse({0, bad, 0}, good_covariance()), PoseVerdict::kNotFinite);
    EXPECT_EQ(reason_to_refuse({0, 0, bad}, good_covariance()), PoseVerdict::kNotFinite);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        PoseCovariance covariance = good_covariance();
        covariance(i, j) = bad;
        EXPECT_EQ(reason_to_refuse({0, 0, 0}, covariance), PoseVerdict::kNotFinite);
      }
    }
  }
  EXPECT_EQ(reason_to_refuse({1e300, 0, 0}, good_covariance()), PoseVerdict::kNotFinite);
}

TEST(MeasuredPose, RefusesACovarianceThatIsNotSymmetric) {
  PoseCovariance covariance = good_covariance();
  covariance(0, 1) = -covariance(0, 1);
  EXPECT_EQ(reason_to_refuse({0, 0, 0}, covariance), PoseVerdict::kCovarianceNotSymmetric);
  covariance = good_covariance();
  covariance(2, 0) *= 1.0 + 1e-9;  // rounding is not asymmetry
  EXPECT_FALSE(reason_to_refuse({0, 0, 0}, covariance));
}

TEST(MeasuredPose, RefusesACovarianceThatIsNotPositive) {
  const PoseCovariance all_zero = PoseCovariance::Zero();
  EXPECT_EQ(reason_to_refuse({0, 0, 0}, all_zero), PoseVerdict::kCovarianceNotPositive);
  EXPECT_EQ(reason_to_refuse({0, 0, 0}, with(1, 1, -2e-6)), PoseVerdict::kCovarianceNotPositive);
  EXPECT_EQ(reason_to_refuse({0, 0, 0}, with(2, 2, 0.0)), PoseVerdict::kCovarianceNotPositive);
  // Correlations beyond one, and three that contradict each other.
  EXPECT_EQ(reason_to_refuse({0, 0, 0}, with(0, 1, 2.1e-6)), PoseVerdict::kCovarianceNotPositive);
  PoseCovariance contradictory;
  contradictory << 1.0, 0.9, -0.9, 0.9, 1.0, 0.9, -0.9, 0.9, 1.0;
  EXPECT_EQ(reason_to_refuse({0, 0, 0}, contradictory), PoseVerdict::kCovarianceNotPositive);
}

}  // namespace
}  // namespace nadir::fusion
