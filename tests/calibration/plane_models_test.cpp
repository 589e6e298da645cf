// Every model that can be fitted: exact recovery, Jacobians against numeric ones, inverses.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "calibration/calibration_file.h"
#include "calibration/fit/fit.h"
#include "tests/calibration/camera_points.h"
#include "tests/calibration/synthetic_points.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::calibration {
namespace {

using Eigen::Vector2d;
using vision::PixelPoint;

/// A map of each kind that no points have seen: what the fits must recover.
PlaneMap exact_map(ModelKind model) {
  if (const int order = polynomial_order(model); order > 0) {
    PolynomialMap::Parameters p;
    p.order = order;
    p.centre_px = {630.0, 470.0};
    p.scale_px = 600.0;
    const int terms = polynomial_terms(order);
    p.coefficients_m = PolynomialCoefficients::Zero(2, terms);
    for (int term = 3; term < terms; ++term) {
      p.coefficients_m.col(term) << 0.02 * std::sin(term), 0.02 * std::cos(3.0 * term);
    }
    p.coefficients_m.leftCols<3>() << 0.2, 1.8, 0.05, -0.1, 0.04, -1.9;
    p.information_inverse = PolynomialInformation::Identity(terms, terms);
    return PlaneMap(PolynomialMap(p));
  }
  RadialMap::Parameters p;
  p.kind = model;
  p.centre_px = {639.5, 479.5};
  p.scale_px = 630.0;
  p.homography_m << 1.9, 0.1, 0.3, 0.08, -2.0, -0.2, 0.02, -0.03, 1.0;
  if (model != ModelKind::kHomography) p.k1 = -0.06;
  if (model == ModelKind::kRadial2) {
    p.k2 = 0.01;
    p.centre_px = {655.0, 470.0};
  }
  const int count = parameter_count(model);
  p.information_inverse = RadialInformation::Identity(count, count);
  return PlaneMap(RadialMap(p));
}

FieldPoints points_of(const PlaneMap& map) {
  FieldPoints points;
  for (int row = 0; row < 9; ++row) {
    for (int column = 0; column < 12; ++column) {
      const PixelPoint pixel(1279.0 * column / 11.0, 959.0 * row / 8.0);
      points.points.push_back({pixel, map.plane_from_pixel(pixel), 0});
    }
  }
  return points;
}

FitOptions centred() { return {PixelPoint(639.5, 479.5), {}}; }

std::vector<PixelPoint> places() {
  std::vector<PixelPoint> pixels;
  for (double u = 15.0; u < 1280.0; u += 125.0) {
    for (double v = 10.0; v < 960.0; v += 104.0) pixels.emplace_back(u, v);
  }
  return pixels;
}

class PlaneModel : public testing::TestWithParam<ModelKind> {};

TEST_P(PlaneModel, IsRecoveredExactly) {
  const PlaneMap truth = exact_map(GetParam());
  const PlaneMap map = fit_map(GetParam(), points_of(truth), centred());
  EXPECT_EQ(map.kind(), GetParam());
  for (const PixelPoint& pixel : places()) {
    EXPECT_LT((map.plane_from_pixel(pixel) - truth.plane_from_pixel(pixel)).norm(), 1e-9);
  }
}

TEST_P(PlaneModel, JacobianIsTheNumericDerivative) {
  const PlaneMap map = exact_map(GetParam());
  constexpr double kStep_px = 1e-2;
  for (const PixelPoint& pixel : places()) {
    Eigen::Matrix2d numeric;
    for (int axis = 0; axis < 2; ++axis) {
      const PixelPoint step = kStep_px * PixelPoint::Unit(axis);
      numeric.col(axis) =
          (map.plane_from_pixel(pixel + step) - map.plane_from_pixel(pixel - step)) /
          (2.0 * kStep_px);
    }
    const Eigen::Matrix2d jacobian = map.jacobian_m_per_px(pixel);
    EXPECT_LT((jacobian - numeric).norm(), 1e-7 * jacobian.norm());
  }
}

TEST_P(PlaneModel, InverseAndItsJacobianReturn) {
  const PlaneMap map = exact_map(GetParam());
  constexpr double kStep_m = 1e-5;
  for (const PixelPoint& pixel : places()) {
    const Vector2d place_m = map.plane_from_pixel(pixel);
    const auto returned = map.pixel_from_plane(place_m);
    ASSERT_TRUE(returned.has_value());
    EXPECT_LT((*returned - pixel).norm(), 1e-5);
    Eigen::Matrix2d numeric;
    for (int axis = 0; axis < 2; ++axis) {
      const Vector2d step = kStep_m * Vector2d::Unit(axis);
      numeric.col(axis) =
          (*map.pixel_from_plane(place_m + step) - *map.pixel_from_plane(place_m - step)) /
          (2.0 * kStep_m);
    }
    const auto jacobian = map.jacobian_px_per_m(place_m);
    ASSERT_TRUE(jacobian.has_value());
    // Newton's inverse of a polynomial is exact to 1e-9 m, so the difference to 1e-4 of a step.
    const double tolerance = polynomial_order(GetParam()) > 0 ? 1e-4 : 1e-7;
    EXPECT_LT((*jacobian - numeric).norm(), tolerance * jacobian->norm());
  }
}

INSTANTIATE_TEST_SUITE_P(All, PlaneModel, testing::ValuesIn(kAllModels),
                         [](const auto& test) { return std::string(model_name(test.param)); });

TEST(RadialMap, ParameterJacobianIsTheNumericDerivative) {
  const PlaneMap whole = exact_map(ModelKind::kRadial2);
  const RadialMap& map = std::get<RadialMap>(whole.model());
  const auto moved = [&map](int index, double step) {
    RadialMap::Parameters p = map.parameters();
    if (index < 8) p.homography_m(index / 3, index % 3) += step;
    if (index == 8) p.k1 += step;
    if (index == 9) p.k2 += step;
    if (index > 9) p.centre_px[index - 10] += step * p.scale_px;
    return RadialMap(p);
  };
  for (const PixelPoint& pixel : places()) {
    const RadialParameterJacobian jacobian = map.parameter_jacobian(pixel);
    for (int index = 0; index < kMaxRadialParameters; ++index) {
      const Vector2d numeric = (moved(index, 1e-6).plane_from_pixel(pixel) -
                                moved(index, -1e-6).plane_from_pixel(pixel)) /
                               2e-6;
      EXPECT_LT((jacobian.col(index) - numeric).norm(), 1e-7 * (1.0 + numeric.norm())) << index;
    }
  }
}

TEST(RadialMap, FollowsTheSyntheticCamera) {
  const vision::CameraModel camera = experiment_camera(-0.25, 0.03);
  const PlaneMap map = fit_map(ModelKind::kRadial2, survey(camera), experiment_options());
  EXPECT_LT(true_rms_m(map, camera), 1e-9);
}

TEST(RadialMap, HasAPlaceForEveryPixelAndNoPixelBeyondTheFold) {
  const PlaneMap map =
      fit_map(ModelKind::kRadial, survey(experiment_camera(-0.3)), experiment_options());
  for (const double u : {-2000.0, -200.0, 3000.0}) {
    EXPECT_TRUE(map.plane_from_pixel({u, 400.0}).allFinite());
    EXPECT_TRUE(map.jacobian_m_per_px({u, 400.0}).allFinite());
  }
  EXPECT_FALSE(map.pixel_from_plane({8.0, 0.0}).has_value());
}

TEST(RadialMap, NeedsNoDistortionToFindItsLensCentre) {
  // Without distortion every centre is as good: the map must be right all the same.
  const vision::CameraModel camera = experiment_camera(0.0);
  const PlaneMap map = fit_map(ModelKind::kRadial2, survey(camera), experiment_options());
  EXPECT_LT(true_rms_m(map, camera), 1e-9);
  EXPECT_TRUE(map.sampling_covariance_m2({300.0, 200.0}).allFinite());
}

TEST(RadialMap, CanBeReadAgainWhereItsCentreIsHardlyKnown) {
  // Without distortion the lens centre's variance is huge, and its covariance nearly singular.
  const vision::ScratchFolder folder;
  for (unsigned seed = 0; seed < 10; ++seed) {
    std::mt19937_64 random(seed);
    const FieldPoints points = with_noise(survey(experiment_camera(0.0), 5, 4), 0.2, 0.0, random);
    for (const StatedNoise& noise : {StatedNoise{}, StatedNoise{0.2, {}}, StatedNoise{0.2, 0.01}}) {
      const FieldFit fit = fit_field(ModelKind::kRadial2, points, noise, experiment_options());
      const std::string text = calibration_yaml(
          {.map = fit.map, .points_box = pixel_box(points), .residuals = fit.residuals});
      EXPECT_EQ(calibration_yaml(load_calibration(folder.write("cal.yaml", text))), text);
    }
  }
}

TEST(ModelKind, NamesAndNumbersBelongTogether) {
  for (const ModelKind model : kAllModels) {
    EXPECT_EQ(model_from_name(model_name(model)), model);
    EXPECT_EQ(exact_map(model).kind(), model);
  }
  EXPECT_EQ(model_from_name("polynomial6"), std::nullopt);
  EXPECT_EQ(parameter_count(ModelKind::kPolynomial5), 42);
  EXPECT_EQ(least_points(ModelKind::kRadial), 5);
}

TEST(PlaneMap, KnowsWhatIsOutsideOfItsPoints) {
  const FieldPoints points = points_of(exact_map(ModelKind::kRadial));
  const PlaneMap map = fit_field(ModelKind::kRadial, points, {}, centred()).map;
  EXPECT_FALSE(map.is_extrapolated({640.0, 480.0}));
  EXPECT_FALSE(map.is_extrapolated({0.0, 0.0}));
  EXPECT_TRUE(map.is_extrapolated({-1.0, 480.0}));
  EXPECT_FALSE(exact_map(ModelKind::kRadial).is_extrapolated({-1.0, 480.0}));  // nothing is known
}

}  // namespace
}  // namespace nadir::calibration
