#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "calibration/fit/fit.h"
#include "tests/calibration/synthetic_points.h"
#include "tests/vision/input_error_line.h"

namespace nadir::calibration {
namespace {

using vision::input_error_line;
using vision::PixelPoint;

std::vector<PixelPoint> places_in_the_image() {
  std::vector<PixelPoint> places;
  for (double u = 80.0; u < kWidth_px; u += 160.0) {
    for (double v = 60.0; v < kHeight_px; v += 140.0) places.emplace_back(u, v);
  }
  return places;
}

const PolynomialMap& polynomial(const FieldFit& fit) {
  return std::get<PolynomialMap>(fit.map.model());
}

TEST(PolynomialFit, RecoversExactQuadratic) {
  const FieldFit fit = fit_polynomial2(grid_points(6, 5, quadratic_truth), {});
  for (const PixelPoint& pixel : places_in_the_image()) {
    EXPECT_LT((fit.map.plane_from_pixel(pixel) - quadratic_truth(pixel)).norm(), 1e-9);
  }
  EXPECT_LT(fit.residuals.max_m, 1e-9);
  EXPECT_EQ(fit.residuals.points, 30);
}

TEST(PolynomialFit, RecoversExactQuadraticFromSixPoints) {
  FieldPoints points = grid_points(3, 3, quadratic_truth);
  points.points.erase(points.points.begin() + 6, points.points.end());
  points.points[3].pixel.y() = kHeight_px;
  points.points[3].position_m = quadratic_truth(points.points[3].pixel);
  const FieldFit fit = fit_polynomial2(points, {});
  EXPECT_LT((fit.map.plane_from_pixel({640, 480}) - quadratic_truth({640, 480})).norm(), 1e-9);
  // No degree of freedom is left: one pixel of noise is taken, not none.
  EXPECT_NEAR(std::sqrt(polynomial(fit).parameters().noise_variance_m2), 3.05e-3, 0.1e-3);
  const FieldFit stated = fit_polynomial2(points, {.pixel_px = 0.1, .survey_m = {}});
  EXPECT_NEAR(std::sqrt(polynomial(stated).parameters().noise_variance_m2), 3.05e-4, 0.1e-4);
}

TEST(PolynomialFit, JacobianIsTheNumericDerivative) {
  const FieldFit fit = fit_polynomial2(grid_points(7, 6, barrel_truth), {});
  constexpr double kStep_px = 1e-2;
  for (const PixelPoint& pixel : places_in_the_image()) {
    Eigen::Matrix2d numeric;
    for (int axis = 0; axis < 2; ++axis) {
      const PixelPoint step = kStep_px * PixelPoint::Unit(axis);
      numeric.col(axis) =
          (fit.map.plane_from_pixel(pixel + step) - fit.map.plane_from_pixel(pixel - step)) /
          (2.0 * kStep_px);
    }
    const Eigen::Matrix2d jacobian = fit.map.jacobian_m_per_px(pixel);
    EXPECT_LT((jacobian - numeric).norm(), 1e-7 * jacobian.norm());
  }
}

TEST(PolynomialFit, StatisticsAreThoseOfTheResiduals) {
  std::mt19937_64 random(7);
  const FieldPoints points = with_noise(grid_points(6, 5, quadratic_truth), 0.0, 0.004, random);
  const FieldFit fit = fit_polynomial2(points, {});
  double sum_m2 = 0.0;
  double max_m = 0.0;
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const double distance_m =
        (points.points[i].position_m - fit.map.plane_from_pixel(points.points[i].pixel)).norm();
    EXPECT_NEAR(fit.point_residuals[i].distance_m, distance_m, 1e-15);
    // Nearly the same scale everywhere and in both axes: 3.05 mm/px within 10 %.
    EXPECT_NEAR(fit.point_residuals[i].distance_px, distance_m / 3.05e-3,
                0.1 * distance_m / 3.05e-3);
    sum_m2 += distance_m * distance_m;
    max_m = std::max(max_m, distance_m);
  }
  EXPECT_NEAR(fit.residuals.rms_m, std::sqrt(sum_m2 / 30.0), 1e-12);
  EXPECT_NEAR(fit.residuals.max_m, max_m, 1e-15);
  EXPECT_LT(fit.residuals.p95_m, fit.residuals.max_m);
  EXPECT_GT(fit.residuals.p95_m, fit.residuals.rms_m);
}

/// The scatter of 500 fits against what each of them predicts for itself.
TEST(PolynomialFit, PredictsItsSamplingErrorInMonteCarlo) {
  constexpr int kRuns = 500;
  constexpr double kPixelNoise_px = 0.3;
  std::mt19937_64 random(42);
  const FieldPoints exact = grid_points(6, 5, quadratic_truth);
  const std::vector<PixelPoint> places = places_in_the_image();
  std::vector<double> scatter_m2(places.size(), 0.0);
  std::vector<double> predicted_m2(places.size(), 0.0);
  for (int run = 0; run < kRuns; ++run) {
    const FieldFit fit = fit_polynomial2(with_noise(exact, kPixelNoise_px, 0.0, random),
                                         {.pixel_px = kPixelNoise_px, .survey_m = {}});
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Eigen::Vector2d error_m =
          fit.map.plane_from_pixel(places[i]) - quadratic_truth(places[i]);
      scatter_m2[i] += error_m.squaredNorm() / (2.0 * kRuns);
      predicted_m2[i] += polynomial(fit).sampling_variance_m2(places[i]) / kRuns;
    }
  }
  double mean_ratio = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double ratio = scatter_m2[i] / predicted_m2[i];
    EXPECT_NEAR(ratio, 1.0, 0.15) << "at " << places[i].transpose();  // 3.4 sigma of 1000 squares
    mean_ratio += ratio / static_cast<double>(places.size());
  }
  EXPECT_NEAR(mean_ratio, 1.0, 0.05);
}

/// The true error of the map on places between the points against what it publishes of itself; with
/// 425 points, which the field sees in 128 neighbourhoods, too.
TEST(PolynomialFit, CountsUnexplainedResidualAsLackOfFitNearBy) {
  std::mt19937_64 random(3);
  for (const int columns : {9, 25}) {
    const auto exact = grid_points(columns, columns == 9 ? 7 : 17, barrel_truth);
    const FieldPoints points = with_noise(exact, 0.1, 0.0, random);
    const FieldFit fit = fit_polynomial2(points, {.pixel_px = 0.1, .survey_m = {}});
    EXPECT_GT(fit.residuals.rms_m, 10.0 * fit.explained_rms_m);
    const LackOfFit& lack = fit.map.support().lack_of_fit;
    double error_m2 = 0.0;
    double lack_m2 = 0.0;
    double difference_m2 = 0.0;
    for (const PixelPoint& pixel : places_in_the_image()) {
      const double error_here_m2 =
          (fit.map.plane_from_pixel(pixel) - barrel_truth(pixel)).squaredNorm();
      const double lack_here_m2 = lack.mean_square_m2(pixel).sum();
      error_m2 += error_here_m2;
      lack_m2 += lack_here_m2;
      difference_m2 += std::abs(lack_here_m2 - error_here_m2);
    }
    EXPECT_NEAR(std::sqrt(lack_m2 / error_m2), 1.0, 0.05) << columns;
    EXPECT_LT(difference_m2, 0.2 * error_m2) << columns;  // place by place, not only on average
  }
}

TEST(PolynomialFit, NoLackOfFitWhereTheNoiseExplainsAll) {
  std::mt19937_64 random(5);
  const FieldPoints points = with_noise(grid_points(20, 15, quadratic_truth), 0.2, 0.001, random);
  const StatedNoise noise{.pixel_px = 0.2, .survey_m = 0.001};
  const FieldFit fit = fit_polynomial2(points, noise);
  EXPECT_NEAR(fit.residuals.rms_m / fit.explained_rms_m, 1.0, 0.06);
  const auto& parameters = polynomial(fit).parameters();
  EXPECT_NEAR(parameters.noise_variance_m2,
              noise.variance_m2(fit.map.jacobian_m_per_px({640, 480})).mean(), 1e-9);
  const FieldFit unstated = fit_polynomial2(points, {});
  const auto& careful = polynomial(unstated).parameters();
  EXPECT_NEAR(careful.noise_variance_m2 / parameters.noise_variance_m2, 1.0, 0.15);
  for (const PixelPoint& pixel : places_in_the_image()) {
    EXPECT_LT(fit.map.support().lack_of_fit.mean_square_m2(pixel).maxCoeff(),
              0.12 * parameters.noise_variance_m2);
    // What nobody explained may be an error of the map as well.
    EXPECT_GE(unstated.map.support().lack_of_fit.mean_square_m2(pixel).minCoeff(),
              careful.noise_variance_m2 * 0.8);
  }
}

TEST(PolynomialFit, RefusesTooFewPoints) {
  FieldPoints points = grid_points(3, 3, quadratic_truth);
  points.points.resize(5);
  EXPECT_EQ(input_error_line([&] { fit_polynomial2(points, {}); }),
            "points.csv: holds 5 points, too few for polynomial2; give at least 12, better 20 or "
            "more, spread to the corners of the field");
}

TEST(PolynomialFit, RefusesPointsOnOneLineOrConic) {
  const std::string expected =
      "points.csv: the points do not determine polynomial2: they lie on one line or one curve of "
      "second "
      "order; spread them over the field in at least three rows and three columns";
  FieldPoints line = grid_points(8, 3, quadratic_truth);
  for (FieldPoint& point : line.points) {
    point.pixel.y() = 100.0 + 0.5 * point.pixel.x();
    point.position_m = quadratic_truth(point.pixel);
  }
  EXPECT_EQ(input_error_line([&] { fit_polynomial2(line, {}); }), expected);
  EXPECT_EQ(input_error_line([&] { fit_polynomial2(grid_points(8, 2, quadratic_truth), {}); }),
            expected);
  FieldPoints circle{"points.csv", {}};
  for (int i = 0; i < 12; ++i) {
    const PixelPoint pixel(640.0 + 400.0 * std::cos(0.5 * i), 480.0 + 400.0 * std::sin(0.5 * i));
    circle.points.push_back({pixel, quadratic_truth(pixel), i + 2});
  }
  EXPECT_EQ(input_error_line([&] { fit_polynomial2(circle, {}); }), expected);
  // A line that was clicked with an error of a pixel is still a line.
  std::mt19937_64 random(1);
  FieldPoints clicked = with_noise(line, 1.0, 0.0, random);
  EXPECT_EQ(input_error_line([&] { fit_polynomial2(clicked, {}); }), expected);
}

TEST(PolynomialFit, RefusesNumbersThatAreNotFinite) {
  FieldPoints points = grid_points(4, 4, quadratic_truth);
  points.points[6].position_m.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(input_error_line([&] { fit_polynomial2(points, {}); }),
            "points.csv:8: a number is not finite; correct or remove the point");
}

TEST(PolynomialFit, RefusesOnePixelWithTwoPlaces) {
  FieldPoints points = grid_points(4, 4, quadratic_truth);
  points.points[6].pixel = points.points[2].pixel;
  EXPECT_EQ(input_error_line([&] { fit_polynomial2(points, {}); }),
            "points.csv:8: the pixel of line 4 stands here again with another place in metres; "
            "remove the "
            "wrong one of the two");
  points.points[6].position_m = points.points[2].position_m;  // the same row twice does no harm
  EXPECT_LT(fit_polynomial2(points, {}).residuals.max_m, 1e-9);
}

TEST(PolynomialFit, RefusesPlacesOnOneLine) {
  FieldPoints points = grid_points(4, 4, quadratic_truth);
  for (FieldPoint& point : points.points) point.position_m.y() = 2.0 * point.position_m.x();
  EXPECT_EQ(input_error_line([&] { fit_polynomial2(points, {}); }),
            "points.csv:2: the fitted map collapses or folds here: pixels and metres do not belong "
            "together; "
            "check that x_m and y_m both vary, and that no rows are mixed up");
}

}  // namespace
}  // namespace nadir::calibration
