#include "fusion/planar_pose.h"

#include <gtest/gtest.h>

#include <cmath>

namespace nadir::fusion {
namespace {

constexpr double kPi = 3.14159265358979323846;

TEST(WrapAngle, LeavesAnglesWithinTheIntervalAlone) {
  for (const double angle_rad : {-3.14, -1.0, 0.0, 1e-300, 2.0, 3.14}) {
    EXPECT_DOUBLE_EQ(wrap_angle(angle_rad), angle_rad);
  }
}

TEST(WrapAngle, IntervalIsOpenBelowAndClosedAbove) {
  EXPECT_EQ(wrap_angle(kPi), kPi);
  EXPECT_EQ(wrap_angle(-kPi), kPi);
  EXPECT_EQ(wrap_angle(std::nextafter(-kPi, 0.0)), std::nextafter(-kPi, 0.0));
}

TEST(WrapAngle, HasTheSameSineAndCosine) {
  for (int k = -1000; k <= 1000; ++k) {
    const double angle_rad = 0.137 * k;
    const double wrapped_rad = wrap_angle(angle_rad);
    EXPECT_GT(wrapped_rad, -kPi);
    EXPECT_LE(wrapped_rad, kPi);
    EXPECT_NEAR(std::sin(wrapped_rad), std::sin(angle_rad), 1e-12);
    EXPECT_NEAR(std::cos(wrapped_rad), std::cos(angle_rad), 1e-12);
  }
}

TEST(WrapAngle, PassesOnWhatIsNotANumber) { EXPECT_TRUE(std::isnan(wrap_angle(std::nan("")))); }

TEST(PoseDifference, GoesTheShortWayAround) {
  const Eigen::Vector3d difference = pose_difference({1.0, 2.0, 3.0}, {0.5, 2.5, -3.0});
  EXPECT_DOUBLE_EQ(difference.x(), 0.5);
  EXPECT_DOUBLE_EQ(difference.y(), -0.5);
  EXPECT_NEAR(difference.z(), 6.0 - 2.0 * kPi, 1e-15);
}

}  // namespace
}  // namespace nadir::fusion
