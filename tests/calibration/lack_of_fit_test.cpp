#include "calibration/diagnosis/lack_of_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "calibration/fit/fit.h"
#include "tests/calibration/synthetic_points.h"

namespace nadir::calibration {
namespace {

using Eigen::Vector2d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Two columns, two rows; the error of x rises with u, that of y with v.
LackOfFit square_grid() {
  return {{{100.0, 200.0}, {300.0, 400.0}},
          2,
          2,
          {{{0.0, 0.0}, {1.0, 0.0}},
           {{2.0, 0.0}, {1.0, 0.0}},
           {{0.0, 4.0}, {3.0, 0.0}},
           {{2.0, 4.0}, {3.0, 0.0}}}};
}

TEST(LackOfFit, IsBilinearBetweenItsNodes) {
  const LackOfFit lack = square_grid();
  EXPECT_EQ(lack.mean_square_m2({300.0, 400.0}), Vector2d(4.0 + 3.0, 16.0));
  // A quarter of the way in u, half of it in v: error (0.5, 2), variance (2, 0).
  EXPECT_TRUE(lack.mean_square_m2({150.0, 300.0}).isApprox(Vector2d(0.25 + 2.0, 4.0)));
}

TEST(LackOfFit, HasTheValueOfItsBorderOutside) {
  const LackOfFit lack = square_grid();
  EXPECT_EQ(lack.mean_square_m2({1000.0, 1000.0}), lack.mean_square_m2({300.0, 400.0}));
  EXPECT_EQ(lack.mean_square_m2({-5.0, 250.0}), lack.mean_square_m2({100.0, 250.0}));
  EXPECT_EQ(lack.mean_square_m2({kNan, 250.0}), lack.mean_square_m2({100.0, 250.0}));
}

TEST(LackOfFit, UniformAndNone) {
  EXPECT_EQ(LackOfFit::uniform(0.25).mean_square_m2({7.0, 1e4}), Vector2d(0.25, 0.25));
  EXPECT_EQ(LackOfFit().mean_square_m2({7.0, 1e4}), Vector2d(0.0, 0.0));
}

TEST(LackOfFit, RefusesWhatDoesNotBelongTogether) {
  const PixelBox box{{0.0, 0.0}, {1.0, 1.0}};
  EXPECT_THROW(LackOfFit(box, 2, 2, std::vector<LackOfFitNode>(3)), std::invalid_argument);
  EXPECT_THROW(LackOfFit(box, 0, 0, {}), std::invalid_argument);
  EXPECT_THROW(LackOfFit({}, 2, 1, std::vector<LackOfFitNode>(2)), std::invalid_argument);
  EXPECT_THROW(LackOfFit(box, 1, 1, {{{0.0, 0.0}, {-1.0, 0.0}}}), std::invalid_argument);
  EXPECT_THROW(LackOfFit(box, 1, 1, {{{kNan, 0.0}, {1.0, 0.0}}}), std::invalid_argument);
}

/// Beyond the points the border's value grows as the leverage does, and never below.
TEST(PolynomialMapCovariance, GrowsOutsideOfThePoints) {
  const FieldFit fit = fit_polynomial2(grid_points(9, 7, barrel_truth), {});
  double last_m2 = 0.0;
  for (const double u : {0.0, -100.0, -200.0, -400.0, -800.0}) {
    const double variance_m2 = fit.map.calibration_covariance_m2({u, 0.0})(0, 0);
    EXPECT_GT(variance_m2, last_m2) << u;
    last_m2 = variance_m2;
  }
  EXPECT_GT(last_m2, 4.0 * fit.map.calibration_covariance_m2({0.0, 0.0})(0, 0));
}

}  // namespace
}  // namespace nadir::calibration
