// A real ceiling camera with a wide lens: 418 surveyed corners, 3.2 m below it.

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

#include "calibration/field_calibration.h"

namespace nadir::calibration {
namespace {

class RealLens : public testing::Test {
 protected:
  void SetUp() override {
    const auto file = std::filesystem::path(NADIR_REAL_DIR) / "cpm_lab/points.csv";
    if (!std::filesystem::exists(file))
      GTEST_SKIP() << "SKIPPED, LOUDLY: no points of a real lens at " << file
                   << "; its error is NOT checked";
    points_ = load_field_points(file);
  }

  FieldResult calibrated(std::optional<ModelKind> model) const {
    FieldSettings settings;
    settings.model = model;
    settings.noise = {.pixel_px = 0.1, .survey_m = 0.0005};
    settings.image_width_px = 2048;
    settings.image_height_px = 2048;
    return calibrate_field(points_, settings);
  }

  FieldPoints points_;
};

TEST_F(RealLens, Polynomial2SaysThatItDoesNotFit) {
  const FieldResult result = calibrated(ModelKind::kPolynomial2);
  EXPECT_NEAR(result.assessment.cross_validated.rms_m, 0.027, 0.003);
  EXPECT_EQ(result.assessment.grade, Grade::kWarn);
  ASSERT_FALSE(result.assessment.findings.empty());
  EXPECT_EQ(result.assessment.findings.front().kind, "misfit");
  EXPECT_NE(result.assessment.findings.front().text.find("use --model"), std::string::npos);
}

TEST_F(RealLens, AutoReachesAMillimetre) {
  const FieldResult result = calibrated(std::nullopt);
  for (const ModelScore& score : result.assessment.models) {
    std::printf("%-12s fitted %7.3f mm, cross-validated %7.3f mm\n", model_name(score.model),
                1e3 * score.residual_rms_m, 1e3 * score.cross_validated_rms_m);
  }
  EXPECT_LT(result.assessment.cross_validated.rms_m, 0.001);
  for (const Finding& finding : result.assessment.findings) {
    EXPECT_NE(finding.grade, Grade::kFail) << finding.text;
  }
}

}  // namespace
}  // namespace nadir::calibration
