#include "calibration/plane_map.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "calibration/fit/fit.h"
#include "tests/calibration/synthetic_points.h"

namespace nadir::calibration {
namespace {

using vision::PixelPoint;

/// x = u + u^2 / 2, y = v on normalised coordinates: folds at u = -1.
PolynomialMap::Parameters folding_parameters() {
  PolynomialMap::Parameters parameters;
  parameters.coefficients_m = PolynomialCoefficients::Zero(2, 6);
  parameters.coefficients_m(0, 1) = 1.0;
  parameters.coefficients_m(0, 3) = 0.5;
  parameters.coefficients_m(1, 2) = 1.0;
  parameters.information_inverse = PolynomialInformation::Identity(6, 6);
  return parameters;
}

TEST(PolynomialBasis, HasTheOrderOfTheDocument) {
  const PolynomialBasis phi = polynomial_basis({2.0, 3.0}, 2);
  Eigen::Matrix<double, 6, 1> expected;
  expected << 1.0, 2.0, 3.0, 4.0, 6.0, 9.0;
  EXPECT_TRUE(phi.isApprox(expected));
  EXPECT_EQ(polynomial_basis({2.0, 3.0}, 5).size(), 21);
  EXPECT_DOUBLE_EQ(polynomial_basis({2.0, 3.0}, 3)[7], 12.0);  // u^2 v
}

TEST(PolynomialMap, RefusesSizesThatDoNotBelongTogether) {
  PolynomialMap::Parameters parameters = folding_parameters();
  parameters.order = 3;
  EXPECT_THROW(PolynomialMap{parameters}, std::invalid_argument);
  parameters = folding_parameters();
  parameters.scale_px = 0.0;
  EXPECT_THROW(PolynomialMap{parameters}, std::invalid_argument);
}

TEST(PlaneMap, InverseReturnsToThePixel) {
  const PlaneMap map = fit_polynomial2(grid_points(9, 7, barrel_truth), {}).map;
  for (double u = 0.0; u <= kWidth_px; u += 128.0) {
    for (double v = 0.0; v <= kHeight_px; v += 120.0) {
      const Eigen::Vector2d place_m = map.plane_from_pixel({u, v});
      const auto pixel = map.pixel_from_plane(place_m);
      ASSERT_TRUE(pixel.has_value()) << u << " " << v;
      EXPECT_LT((map.plane_from_pixel(*pixel) - place_m).norm(), 1e-9);
      EXPECT_LT((*pixel - PixelPoint(u, v)).norm(), 1e-5);
    }
  }
}

TEST(PlaneMap, InverseFindsNothingBeyondAFold) {
  const PlaneMap map{PolynomialMap(folding_parameters())};
  EXPECT_FALSE(map.pixel_from_plane({-0.6, 0.0}).has_value());  // x never falls below -0.5
  const auto pixel = map.pixel_from_plane({-0.375, 0.25});
  ASSERT_TRUE(pixel.has_value());
  EXPECT_NEAR(pixel->x(), -0.5, 1e-8);  // and not -1.5, on the other side
  EXPECT_FALSE(map.pixel_from_plane({std::nan(""), 0.0}).has_value());
}

TEST(PlaneMap, MapsTheCovarianceOfAPixel) {
  PolynomialMap::Parameters parameters = folding_parameters();
  parameters.centre_px = {100.0, 50.0};
  parameters.scale_px = 10.0;
  parameters.noise_variance_m2 = 0.5;
  const PlaneMap map(PolynomialMap(parameters), {LackOfFit::uniform(0.25), {}});
  Eigen::Matrix2d covariance_px2;
  covariance_px2 << 4.0, 1.0, 1.0, 9.0;
  const PlanePoint point =
      map.map({110.0, 50.0}, covariance_px2);  // n = (1, 0), J = diag(0.2, 0.1)
  EXPECT_TRUE(point.position_m.isApprox(Eigen::Vector2d(1.5, 0.0)));
  // phi = (1, 1, 0, 1, 0, 0): phi^T phi = 3.
  Eigen::Matrix2d expected;
  expected << 0.04 * 4.0, 0.02, 0.02, 0.01 * 9.0;
  expected += (0.5 * 3.0 + 0.25) * Eigen::Matrix2d::Identity();
  EXPECT_TRUE(point.covariance_m2.isApprox(expected, 1e-12));
}

}  // namespace
}  // namespace nadir::calibration
