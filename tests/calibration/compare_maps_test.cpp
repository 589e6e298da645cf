// Two calibrations of one camera whose difference is known.

#include "calibration/compare/compare_maps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "calibration/compare/compare_text.h"
#include "tests/calibration/synthetic_points.h"
#include "tests/vision/input_error_line.h"

namespace nadir::calibration {
namespace {

using testing::HasSubstr;

Calibration calibration_of(const FieldPoints& points, const StatedNoise& noise = {}) {
  const FieldFit fit = fit_polynomial2(points, noise);
  return {.map = fit.map,
          .height_m = 0.1,
          .points_box = pixel_box(points),
          .residuals = fit.residuals,
          .noise = noise};
}

FieldPoints moved(FieldPoints points, const Eigen::Vector2d& shift_m, double turn_rad,
                  double scale) {
  Eigen::Matrix2d turn;
  turn << std::cos(turn_rad), -std::sin(turn_rad), std::sin(turn_rad), std::cos(turn_rad);
  for (FieldPoint& point : points.points) {
    point.position_m = shift_m + scale * turn * point.position_m;
  }
  return points;
}

TEST(CompareMaps, FindsAMotionOfTheField) {
  const FieldPoints points = grid_points(8, 7, quadratic_truth);
  const Eigen::Vector2d shift_m(0.012, -0.007);
  constexpr double kTurn = 0.004;
  constexpr double kScale = 1.003;
  const MapComparison comparison =
      compare_maps(calibration_of(points), calibration_of(moved(points, shift_m, kTurn, kScale)),
                   "a.yaml", "b.yaml");
  EXPECT_TRUE(comparison.is_significant);
  EXPECT_NEAR(comparison.motion.turn_rad, kTurn, 1e-9);
  EXPECT_NEAR(comparison.motion.scale, kScale, 1e-9);
  EXPECT_LT(comparison.motion.rest_rms_m, 1e-9);
  for (const PixelDifference& each : comparison.differences) {
    const Eigen::Vector2d& place = each.place_m;
    Eigen::Matrix2d turn;
    turn << std::cos(kTurn), -std::sin(kTurn), std::sin(kTurn), std::cos(kTurn);
    EXPECT_LT((each.difference_m - (shift_m + kScale * turn * place - place)).norm(), 1e-9);
  }
  EXPECT_LE(comparison.rms_m, comparison.worst.difference_m.norm());
  EXPECT_THAT(comparison_summary(comparison), HasSubstr("Was the camera knocked"));
}

TEST(CompareMaps, CallsNoiseNoDifference) {
  const FieldPoints points = grid_points(9, 8, quadratic_truth);
  int significant = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    std::mt19937_64 random(seed);
    const StatedNoise noise{.pixel_px = 0.3, .survey_m = {}};
    const MapComparison comparison =
        compare_maps(calibration_of(with_noise(points, 0.3, 0.0, random), noise),
                     calibration_of(with_noise(points, 0.3, 0.0, random), noise), "a", "b");
    significant += comparison.is_significant ? 1 : 0;
    EXPECT_GT(comparison.expected_rms_m, 0.0);
  }
  EXPECT_LE(significant, 1);
}

TEST(CompareMaps, NoticesAKnockOfOnePixel) {
  const FieldPoints points = grid_points(9, 8, quadratic_truth);
  std::mt19937_64 random(3);
  const StatedNoise noise{.pixel_px = 0.3, .survey_m = {}};
  FieldPoints shifted = points;
  for (FieldPoint& point : shifted.points) point.pixel.x() += 1.0;
  const MapComparison comparison =
      compare_maps(calibration_of(with_noise(points, 0.3, 0.0, random), noise),
                   calibration_of(with_noise(shifted, 0.3, 0.0, random), noise), "a", "b");
  EXPECT_TRUE(comparison.is_significant);
  EXPECT_NEAR(comparison.rms_px, 1.0, 0.15);
}

TEST(CompareMaps, RefusesWhatIsNotOneCamera) {
  const FieldPoints points = grid_points(6, 6, quadratic_truth);
  Calibration small = calibration_of(points);
  Calibration large = small;
  small.image_width_px = 1300;
  small.image_height_px = 1000;
  large.image_width_px = 2600;
  large.image_height_px = 2000;
  EXPECT_THAT(vision::input_error_line([&] { compare_maps(small, large, "a.yaml", "b.yaml"); }),
              HasSubstr("b.yaml: is for images of 2600x2000, but a.yaml for 1300x1000"));
  Calibration elsewhere = calibration_of(points);
  elsewhere.points_box.low_px.x() += 5000.0;
  elsewhere.points_box.high_px.x() += 5000.0;
  EXPECT_THAT(vision::input_error_line([&] { compare_maps(small, elsewhere, "a.yaml", "b.yaml"); }),
              HasSubstr("b.yaml: has its points in another part of the image than a.yaml"));
}

}  // namespace
}  // namespace nadir::calibration
