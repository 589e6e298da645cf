#include "calibration/diagnosis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/calibration/synthetic_points.h"

namespace nadir::calibration {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

std::vector<std::string> remarks(const FieldPoints& points, const StatedNoise& noise) {
  return fit_remarks(points, noise, fit_polynomial2(points, noise));
}

TEST(FitRemarks, SilentWhereAllIsWell) {
  std::mt19937_64 random(11);
  const FieldPoints points = with_noise(grid_points(7, 6, quadratic_truth), 0.2, 0.0, random);
  EXPECT_THAT(remarks(points, {.pixel_px = 0.2, .survey_m = {}}), IsEmpty());
}

TEST(FitRemarks, SayThatTheModelDoesNotFitALens) {
  std::mt19937_64 random(12);
  const FieldPoints points = with_noise(grid_points(7, 6, barrel_truth), 0.2, 0.0, random);
  EXPECT_THAT(
      remarks(points, {.pixel_px = 0.2, .survey_m = {}}),
      ElementsAre(AllOf(StartsWith("polynomial2 leaves"), HasSubstr("the model does not fit"),
                        HasSubstr("the stated noise explains 0.9"))));
  EXPECT_THAT(remarks(points, {}), ElementsAre(HasSubstr("the model probably does not fit"),
                                               HasSubstr("no noise is stated")));
}

TEST(FitRemarks, NameTheLineOfATypingError) {
  std::mt19937_64 random(13);
  FieldPoints points = with_noise(grid_points(8, 7, quadratic_truth), 0.2, 0.0, random);
  points.points[20].position_m.x() += 0.1;
  const std::vector<std::string> found = remarks(points, {.pixel_px = 0.2, .survey_m = {}});
  EXPECT_THAT(found, ElementsAre(HasSubstr("the model does not fit"),
                                 AllOf(StartsWith("stands out against"), HasSubstr("line 22 ("),
                                       Not(HasSubstr("), line")))));
}

TEST(FitRemarks, SeeAMirroredField) {
  std::mt19937_64 random(14);
  FieldPoints points = with_noise(grid_points(7, 6, quadratic_truth), 0.2, 0.0, random);
  for (FieldPoint& point : points.points) point.position_m.y() *= -1.0;
  EXPECT_THAT(remarks(points, {.pixel_px = 0.2, .survey_m = {}}),
              ElementsAre(StartsWith("the field is mirrored")));
}

TEST(FitRemarks, DoubtPointsThatAreTooGood) {
  const FieldPoints exact = grid_points(7, 6, quadratic_truth);
  EXPECT_THAT(remarks(exact, {.pixel_px = 0.2, .survey_m = {}}),
              ElementsAre(HasSubstr("were they computed?")));
  EXPECT_THAT(remarks(exact, {}),
              ElementsAre(HasSubstr("were they computed?"), HasSubstr("no noise is stated")));
}

TEST(FitRemarks, AskForMorePoints) {
  std::mt19937_64 random(15);
  const FieldPoints points = with_noise(grid_points(4, 3, quadratic_truth), 0.2, 0.0, random);
  EXPECT_THAT(remarks(points, {.pixel_px = 0.2, .survey_m = {}}),
              ElementsAre(StartsWith("12 points are few")));
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
