#include "calibration/diagnosis/assessment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/field_calibration.h"
#include "tests/calibration/synthetic_points.h"

namespace nadir::calibration {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

FieldAssessment assessed(const FieldPoints& points, const StatedNoise& noise,
                         ModelKind model = ModelKind::kPolynomial2, int width_px = 0,
                         int height_px = 0) {
  FieldSettings settings;
  settings.model = model;
  settings.noise = noise;
  settings.image_width_px = width_px;
  settings.image_height_px = height_px;
  return calibrate_field(points, settings).assessment;
}

std::vector<std::string> texts(const FieldAssessment& assessment) {
  std::vector<std::string> result;
  for (const Finding& finding : assessment.findings) result.push_back(finding.text);
  return result;
}

const StatedNoise kPixels{.pixel_px = 0.2, .survey_m = {}};

FieldPoints noisy_grid(const Truth& truth, unsigned seed, int columns = 7, int rows = 6) {
  std::mt19937_64 random(seed);
  return with_noise(grid_points(columns, rows, truth), 0.2, 0.0, random);
}

TEST(FieldAssessment, PassesWhereAllIsWell) {
  const FieldAssessment assessment = assessed(noisy_grid(quadratic_truth, 11), kPixels);
  EXPECT_EQ(assessment.grade, Grade::kPass);
  EXPECT_THAT(texts(assessment), IsEmpty());
  ASSERT_TRUE(assessment.lack_of_fit.has_value());
  EXPECT_EQ(assessment.lack_of_fit->degrees_of_freedom, 2 * 42 - 12);
  EXPECT_GT(assessment.lack_of_fit->p_value, 0.01);
  EXPECT_GT(assessment.leave_one_out.rms_m,
            assessment.score(ModelKind::kPolynomial2).residual_rms_m);
  EXPECT_EQ(assessment.models.size(), kAllModels.size());
}

TEST(FieldAssessment, SaysThatTheModelDoesNotFitALens) {
  const FieldPoints points = noisy_grid(barrel_truth, 12);
  const FieldAssessment stated = assessed(points, kPixels);
  EXPECT_EQ(stated.grade, Grade::kWarn);
  EXPECT_LT(stated.lack_of_fit->p_value, 1e-6);
  EXPECT_THAT(
      texts(stated),
      ElementsAre(AllOf(StartsWith("the model does not fit: polynomial2 leaves"),
                        HasSubstr("the stated noise explains 0.9"), HasSubstr("use --model"))));
  EXPECT_THAT(texts(assessed(points, {})),
              ElementsAre(StartsWith("the model probably does not fit: polynomial2 leaves"),
                          StartsWith("no noise is stated")));
}

TEST(FieldAssessment, FailsForATypingError) {
  FieldPoints points = noisy_grid(quadratic_truth, 13, 8, 7);
  points.points[20].position_m.x() += 0.1;
  const FieldAssessment assessment = assessed(points, kPixels);
  EXPECT_EQ(assessment.grade, Grade::kFail);
  EXPECT_THAT(texts(assessment), Contains(StartsWith("line 22: x_m is ")));
  EXPECT_EQ(assessment.findings.front().grade, Grade::kFail);  // the gravest first
}

TEST(FieldAssessment, FailsForAMirroredField) {
  FieldPoints points = noisy_grid(quadratic_truth, 14);
  for (FieldPoint& point : points.points) point.position_m.y() *= -1.0;
  const FieldAssessment assessment = assessed(points, kPixels);
  EXPECT_EQ(assessment.grade, Grade::kFail);
  EXPECT_THAT(texts(assessment), ElementsAre(AllOf(StartsWith("the field is mirrored"),
                                                   HasSubstr("has y_m the wrong sign?"))));
}

TEST(FieldAssessment, DoubtsPointsThatAreTooGood) {
  const FieldPoints exact = grid_points(7, 6, quadratic_truth);
  EXPECT_THAT(texts(assessed(exact, kPixels)), ElementsAre(HasSubstr("were they computed?")));
  EXPECT_THAT(texts(assessed(exact, {})),
              ElementsAre(HasSubstr("were they computed?"), HasSubstr("no noise is stated")));
}

TEST(FieldAssessment, AsksForMorePointsAndRefusesFewerThanParameters) {
  const FieldAssessment few = assessed(noisy_grid(quadratic_truth, 15, 4, 3), kPixels);
  EXPECT_EQ(few.grade, Grade::kPass);
  EXPECT_THAT(texts(few), ElementsAre(StartsWith("12 points are few")));
  const FieldAssessment less = assessed(noisy_grid(quadratic_truth, 16, 3, 3), kPixels);
  EXPECT_EQ(less.grade, Grade::kFail);
  EXPECT_THAT(texts(less), Contains(StartsWith("9 points are too few for polynomial2, which has 12 "
                                               "parameters")));
}

TEST(FieldAssessment, NamesPartsOfTheImageWithoutPoints) {
  FieldPoints points = noisy_grid(quadratic_truth, 17, 12, 9);
  std::erase_if(points.points, [](const FieldPoint& point) { return point.pixel.x() > 700.0; });
  EXPECT_THAT(texts(assessed(points, kPixels)), IsEmpty());  // the image's size is not known
  const FieldAssessment assessment = assessed(points, kPixels, ModelKind::kPolynomial2, 1290, 970);
  EXPECT_EQ(assessment.grade, Grade::kWarn);
  EXPECT_THAT(texts(assessment),
              ElementsAre(AllOf(StartsWith("50 % of the image has no points around it"),
                                HasSubstr("top right"), HasSubstr("extrapolated"))));
}

TEST(FieldAssessment, SeesAStripAndARepeatedRow) {
  FieldPoints points = noisy_grid(quadratic_truth, 18, 12, 9);
  for (FieldPoint& point : points.points) {
    point.pixel.y() = 480.0 + 0.05 * (point.pixel.y() - 480.0);
    point.position_m = quadratic_truth(point.pixel);
  }
  points.points.push_back(points.points[3]);
  points.points.back().line = 110;
  EXPECT_THAT(texts(assessed(points, kPixels)),
              AllOf(Contains(StartsWith("the points lie on a strip")),
                    Contains(StartsWith("line 110 is the same as line 5"))));
}

TEST(CalibrateField, RefusesWithTheDiagnosisWhatCannotBeFitted) {
  // Swapped rows that fold the map: the rows are named, not the fold.
  FieldPoints points = noisy_grid(quadratic_truth, 19, 5, 4);
  std::swap(points.points[0].position_m, points.points[19].position_m);
  std::swap(points.points[4].position_m, points.points[15].position_m);
  FieldSettings settings;
  settings.noise = kPixels;
  try {
    const FieldResult result = calibrate_field(points, settings);
    EXPECT_EQ(result.assessment.grade, Grade::kFail);
  } catch (const CalibrationRefused& refused) {
    EXPECT_EQ(grade_of(refused.findings()), Grade::kFail);
    EXPECT_NE(std::string(refused.what()), "");
  }
}

TEST(WorstPoints, StandInOrder) {
  FieldPoints points = grid_points(8, 7, quadratic_truth);
  points.points[30].position_m.y() += 0.05;
  points.points[9].position_m.y() -= 0.10;
  const FieldFit fit = fit_polynomial2(points, {});
  EXPECT_THAT(worst_points(fit, 2), ElementsAre(9U, 30U));
  EXPECT_EQ(worst_points(fit, 1000).size(), 56U);
}

}  // namespace
}  // namespace nadir::calibration
