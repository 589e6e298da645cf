#include "calibration/validation.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/calibration/synthetic_points.h"

namespace nadir::calibration {
namespace {

Calibration calibrated(const FieldPoints& points, const StatedNoise& noise) {
  const FieldFit fit = fit_polynomial2(points, noise);
  return {fit.map, 0.1, 0, 0, pixel_box(points), fit.residuals, noise};
}

/// Mean over many calibrations, each judged by other points with the same noise.
double mean_coverage(const Truth& truth, double pixel_px, double survey_m,
                     const StatedNoise& stated) {
  constexpr int kRuns = 100;
  std::mt19937_64 random(31);
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const auto fitted = with_noise(grid_points(8, 6, truth), pixel_px, survey_m, random);
    const auto others = with_noise(grid_points(7, 5, truth), pixel_px, survey_m, random);
    sum += validate(calibrated(fitted, stated), others).coverage95;
  }
  return sum / kRuns;
}

TEST(Validation, CoversWhatItPromises) {
  // 3500 points: one sigma of the share is 0.4 %, and a little care is built in (lack of fit is
  // never negative).
  const double coverage =
      mean_coverage(quadratic_truth, 0.3, 0.001, {.pixel_px = 0.3, .survey_m = 0.001});
  EXPECT_GT(coverage, 0.94);
  EXPECT_LT(coverage, 0.975);
}

TEST(Validation, CoversAlsoWithoutStatedNoise) {
  const double coverage = mean_coverage(quadratic_truth, 0.3, 0.001, {});
  EXPECT_GT(coverage, 0.94);
  EXPECT_LT(coverage, 0.975);
}

TEST(Validation, CoversAModelThatDoesNotFit) {
  const double coverage = mean_coverage(barrel_truth, 0.1, 0.0, {.pixel_px = 0.1, .survey_m = {}});
  EXPECT_GT(coverage, 0.98);  // 0.886 with one lack of fit for the whole field
}

TEST(Validation, SeesAShiftedField) {
  std::mt19937_64 random(33);
  const auto points = with_noise(grid_points(8, 6, quadratic_truth), 0.3, 0.0, random);
  FieldPoints shifted = points;
  for (FieldPoint& point : shifted.points) point.position_m.x() += 0.02;
  const Validation validation =
      validate(calibrated(points, {.pixel_px = 0.3, .survey_m = {}}), shifted);
  EXPECT_NEAR(validation.residuals.rms_m, 0.02, 0.001);
  EXPECT_LT(validation.coverage95, 0.05);
}

/// A real ceiling camera with a wide lens: what order 2 leaves there was measured independently
/// (26.8 mm in cross-validation on more corners of the same camera).
TEST(Validation, IsHonestOnARealWideLens) {
  const std::filesystem::path file = std::filesystem::path(NADIR_REAL_DIR) / "cpm_lab/points.csv";
  if (!std::filesystem::exists(file))
    GTEST_SKIP() << "SKIPPED, LOUDLY: no points of a real lens at " << file
                 << "; validation of one is NOT checked";
  const FieldPoints points = load_field_points(file);
  FieldPoints fitted{points.file, {}};
  FieldPoints others{points.file, {}};
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    (i % 2 == 0 ? fitted : others).points.push_back(points.points[i]);
  }
  const Calibration calibration = calibrated(fitted, {.pixel_px = 0.1, .survey_m = 0.001});
  const Validation validation = validate(calibration, others);
  EXPECT_EQ(points.points.size(), 418U);
  EXPECT_NEAR(validation.residuals.rms_m, 0.0268, 0.002);
  EXPECT_GT(validation.coverage95, 0.98);
}

}  // namespace
}  // namespace nadir::calibration
