#include "fusion/sine_cosine.h"

#include <gtest/gtest.h>

#include "tests/fusion/random_stream.h"

namespace nadir::fusion {
namespace {

TEST(SineCosine, AgreesWithTheLibrarysLongDoubles) {
  test::RandomStream random(1);
  for (const double range_rad : {1e-8, 0.8, 3.2, 10.0, 300.0}) {
    const double tolerance = range_rad > 10.0 ? 1e-15 : 2.3e-16;
    for (int i = 0; i < 20000; ++i) {
      const double angle_rad = random.uniform(-range_rad, range_rad);
      const SineCosine both = sine_cosine(angle_rad);
      const auto exact = static_cast<long double>(angle_rad);
      ASSERT_NEAR(static_cast<double>(both.sine - std::sin(exact)), 0.0, tolerance) << angle_rad;
      ASSERT_NEAR(static_cast<double>(both.cosine - std::cos(exact)), 0.0, tolerance) << angle_rad;
    }
  }
}

TEST(SineCosine, OfZeroIsExact) {
  EXPECT_EQ(sine_cosine(0.0).sine, 0.0);
  EXPECT_EQ(sine_cosine(0.0).cosine, 1.0);
}

TEST(SineCosine, TurnsQuadrantsTheRightWay) {
  constexpr double kHalfPi = 1.57079632679489661923;
  for (int quadrant = -8; quadrant <= 8; ++quadrant) {
    const SineCosine both = sine_cosine(quadrant * kHalfPi + 0.1);
    EXPECT_NEAR(both.sine, std::sin(quadrant * kHalfPi + 0.1), 1e-15);
    EXPECT_NEAR(both.cosine, std::cos(quadrant * kHalfPi + 0.1), 1e-15);
  }
}

}  // namespace
}  // namespace nadir::fusion
