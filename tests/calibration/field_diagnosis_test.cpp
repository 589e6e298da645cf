// The slips of people who type tables, each in 100 random tables, and 100 tables without any.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <ostream>

#include "calibration/field_calibration.h"
#include "tests/calibration/camera_points.h"
#include "tests/calibration/synthetic_points.h"

namespace nadir::calibration {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kTrials = 100;
constexpr double kPixelNoise_px = 0.2;
constexpr double kSurveyNoise_m = 0.001;
const StatedNoise kStated{.pixel_px = kPixelNoise_px, .survey_m = kSurveyNoise_m};

/// A table as people make it: any lens, any turn of the camera by quarters, 40 to 150 points.
FieldPoints random_table(std::mt19937_64& random) {
  constexpr std::array<double, 5> kLenses = {0.0, -0.005, -0.02, -0.1, -0.2};
  std::uniform_int_distribution<std::size_t> lens(0, kLenses.size() - 1);
  std::uniform_int_distribution<int> quarters(0, 3);
  std::uniform_int_distribution<int> columns(8, 14);
  const auto camera = experiment_camera(kLenses[lens(random)], 0.0, 0.5 * M_PI * quarters(random));
  const int width = columns(random);
  return with_noise(survey(camera, width, 5 + width / 3), kPixelNoise_px, kSurveyNoise_m, random);
}

std::size_t random_row(const FieldPoints& points, std::mt19937_64& random) {
  return std::uniform_int_distribution<std::size_t>(0, points.points.size() - 1)(random);
}

std::vector<Finding> failures(const FieldPoints& points) {
  std::vector<Finding> findings = diagnose_points(points, kStated, experiment_options());
  std::erase_if(findings, [](const Finding& one) { return one.grade != Grade::kFail; });
  return findings;
}

/// What is found in place of what was expected, for the test's words.
std::string text_of(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings) text += finding.kind + ": " + finding.text + "\n";
  return text.empty() ? "nothing" : text;
}

TEST(FieldDiagnosis, IsSilentOnCleanTables) {
  std::mt19937_64 random(101);
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto found = failures(random_table(random));
    EXPECT_THAT(found, IsEmpty()) << trial << " " << text_of(found);
  }
}

TEST(FieldDiagnosis, NamesAPointThatIsOffBy100Millimetres) {
  std::mt19937_64 random(102);
  for (int trial = 0; trial < kTrials; ++trial) {
    FieldPoints points = random_table(random);
    FieldPoint& wrong = points.points[random_row(points, random)];
    const int axis = trial % 2;
    const double off_m = trial % 4 < 2 ? 0.1 : -0.1;
    wrong.position_m[axis] += off_m;
    const auto found = failures(points);
    ASSERT_EQ(found.size(), 1U) << trial << " " << text_of(found);
    EXPECT_EQ(found[0].kind, "typing error");
    EXPECT_THAT(found[0].lines, testing::ElementsAre(wrong.line)) << trial;
    EXPECT_THAT(found[0].text, AllOf(HasSubstr(axis == 0 ? "x_m is " : "y_m is "),
                                     HasSubstr(off_m > 0.0 ? "too large" : "too small")));
    const std::size_t at = found[0].text.find(" is ");
    EXPECT_NEAR(std::stod(found[0].text.substr(at + 4)), 100.0, 8.0) << found[0].text;
  }
}

TEST(FieldDiagnosis, NamesTwoSwappedRows) {
  std::mt19937_64 random(103);
  for (int trial = 0; trial < kTrials; ++trial) {
    FieldPoints points = random_table(random);
    const std::size_t a = random_row(points, random);
    std::size_t b = random_row(points, random);
    if (a == b) b = (a + 1) % points.points.size();
    std::swap(points.points[a].position_m, points.points[b].position_m);
    const auto found = failures(points);
    ASSERT_EQ(found.size(), 1U) << trial << " " << text_of(found);
    EXPECT_EQ(found[0].kind, "swapped points");
    EXPECT_THAT(found[0].lines,
                testing::UnorderedElementsAre(points.points[a].line, points.points[b].line));
  }
}

TEST(FieldDiagnosis, NamesMillimetres) {
  std::mt19937_64 random(104);
  for (int trial = 0; trial < kTrials; ++trial) {
    FieldPoints points = random_table(random);
    for (FieldPoint& point : points.points) point.position_m *= 1000.0;
    const auto found = failures(points);
    ASSERT_EQ(found.size(), 1U) << trial << " " << text_of(found);
    EXPECT_EQ(found[0].kind, "units");
    EXPECT_THAT(found[0].text, HasSubstr("in millimetres. Write metres"));
  }
}

TEST(FieldDiagnosis, NamesAMirroredField) {
  std::mt19937_64 random(105);
  for (int trial = 0; trial < kTrials; ++trial) {
    FieldPoints points = random_table(random);
    for (FieldPoint& point : points.points) point.position_m.y() *= -1.0;
    const auto found = failures(points);
    ASSERT_EQ(found.size(), 1U) << trial << " " << text_of(found);
    EXPECT_EQ(found[0].kind, "mirrored");
  }
}

/// One table, one slip in it, what is to be said.
struct Slip {
  std::string name;
  std::function<void(FieldPoints&)> made;
  std::string kind;
  std::string words;
};

void PrintTo(const Slip& slip, std::ostream* stream) { *stream << slip.name; }

class FieldSlip : public testing::TestWithParam<Slip> {};

TEST_P(FieldSlip, IsNamed) {
  std::mt19937_64 random(106);
  FieldPoints points =
      with_noise(survey(experiment_camera(-0.1)), kPixelNoise_px, kSurveyNoise_m, random);
  GetParam().made(points);
  const auto found = failures(points);
  ASSERT_EQ(found.size(), 1U) << text_of(found);
  EXPECT_EQ(found[0].kind, GetParam().kind);
  EXPECT_THAT(found[0].text, HasSubstr(GetParam().words));
}

INSTANTIATE_TEST_SUITE_P(
    Slips, FieldSlip,
    testing::Values(Slip{"sign_of_a_row", [](auto& p) { p.points[20].position_m.x() *= -1.0; },
                         "typing error", "x_m has the wrong sign"},
                    Slip{"axes_of_a_row", [](auto& p) { p.points[23].position_m.reverseInPlace(); },
                         "typing error", "x_m and y_m are swapped"},
                    Slip{"millimetres_in_a_row", [](auto& p) { p.points[7].position_m *= 1000.0; },
                         "typing error", "x_m and y_m are in millimetres"},
                    Slip{"centimetres_of_y", [](auto& p) { p.points[7].position_m.y() *= 100.0; },
                         "typing error", "y_m is in centimetres"},
                    Slip{"copied_place",
                         [](auto& p) { p.points[50].position_m = p.points[30].position_m; },
                         "repeated place", "line 52 repeats the place of line 32"},
                    Slip{"both_axes",
                         [](auto& p) { p.points[50].position_m += Eigen::Vector2d(0.07, -0.08); },
                         "typing error", "off by 7"},
                    Slip{"swapped_columns",
                         [](auto& p) {
                           for (auto& point : p.points) point.position_m.reverseInPlace();
                         },
                         "mirrored", "are x_m and y_m swapped?"},
                    Slip{"one_column_in_millimetres",
                         [](auto& p) {
                           for (auto& point : p.points) point.position_m.x() *= 1000.0;
                         },
                         "units", "one of the two is not in metres"}),
    [](const auto& test) { return test.param.name; });

TEST(FieldDiagnosis, SaysThatRowsAreMixedUp) {
  FieldPoints points = survey(experiment_camera(-0.1));
  std::mt19937_64 random(107);
  for (std::size_t i = points.points.size() - 1; i > 0; --i) {
    const std::size_t other = std::uniform_int_distribution<std::size_t>(0, i)(random);
    std::swap(points.points[i].position_m, points.points[other].position_m);
  }
  std::string said;
  try {
    said = text_of(calibrate_field(points, {}).assessment.findings);
  } catch (const std::exception& error) {
    said = error.what();
  }
  EXPECT_THAT(said, HasSubstr("rows"));
  EXPECT_THAT(said, HasSubstr("mixed up"));
}

}  // namespace
}  // namespace nadir::calibration
