#include "calibration/calibration_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/calibration/synthetic_points.h"
#include "tests/vision/input_error_line.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::calibration {
namespace {

using testing::HasSubstr;
using vision::input_error_line;
using vision::ScratchFolder;

Calibration example() {
  std::mt19937_64 random(21);
  const FieldPoints points = with_noise(grid_points(7, 6, quadratic_truth), 0.2, 0.0, random);
  const StatedNoise noise{.pixel_px = 0.15, .survey_m = {}};
  const FieldFit fit = fit_polynomial2(points, noise);
  return {fit.map, 0.12, 1282, 962, pixel_box(points), fit.residuals, noise};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return text.replace(place, from.size(), to);
}

class CalibrationFile : public testing::Test {
 protected:
  /// The complaint about the example's text with one thing replaced, without the folder's name.
  std::string line_with(const std::string& from, const std::string& to) const {
    const auto file = folder_.write("cal.yaml", replaced(calibration_yaml(example()), from, to));
    return replaced(input_error_line([&] { load_calibration(file); }), file.string(), "cal.yaml");
  }

  ScratchFolder folder_;
};

TEST_F(CalibrationFile, KeepsEveryBit) {
  const Calibration written = example();
  const Calibration read = load_calibration(folder_.write("cal.yaml", calibration_yaml(written)));
  const auto& before = std::get<PolynomialMap>(written.map.model()).parameters();
  const auto& after = std::get<PolynomialMap>(read.map.model()).parameters();
  EXPECT_EQ(after.order, before.order);
  EXPECT_EQ(after.centre_px, before.centre_px);
  EXPECT_EQ(after.scale_px, before.scale_px);
  EXPECT_EQ(after.coefficients_m, before.coefficients_m);
  EXPECT_EQ(after.information_inverse, before.information_inverse);
  EXPECT_EQ(after.noise_variance_m2, before.noise_variance_m2);
  const LackOfFit& lack_before = written.map.support().lack_of_fit;
  const LackOfFit& lack_after = read.map.support().lack_of_fit;
  EXPECT_EQ(lack_after.box().low_px, lack_before.box().low_px);
  EXPECT_EQ(lack_after.box().high_px, lack_before.box().high_px);
  EXPECT_EQ(lack_after.columns(), lack_before.columns());
  EXPECT_EQ(lack_after.rows(), lack_before.rows());
  ASSERT_EQ(lack_after.nodes().size(), lack_before.nodes().size());
  for (std::size_t i = 0; i < lack_before.nodes().size(); ++i) {
    EXPECT_EQ(lack_after.nodes()[i].error_m, lack_before.nodes()[i].error_m);
    EXPECT_EQ(lack_after.nodes()[i].variance_m2, lack_before.nodes()[i].variance_m2);
  }
  EXPECT_EQ(read.map.support().hull.vertices(), written.map.support().hull.vertices());
  EXPECT_EQ(read.height_m, 0.12);
  EXPECT_EQ(read.image_width_px, 1282);
  EXPECT_EQ(read.image_height_px, 962);
  EXPECT_EQ(read.points_box.low_px, written.points_box.low_px);
  EXPECT_EQ(read.points_box.high_px, written.points_box.high_px);
  EXPECT_EQ(read.residuals.points, 42);
  EXPECT_EQ(read.residuals.p95_px, written.residuals.p95_px);
  EXPECT_EQ(read.noise.pixel_px, 0.15);
  EXPECT_FALSE(read.noise.survey_m.has_value());
  EXPECT_EQ(calibration_yaml(read), calibration_yaml(written));
}

TEST_F(CalibrationFile, StartsWithItsVersion) {
  EXPECT_EQ(calibration_yaml(example()).rfind("nadir_calibration: 2\n", 0), 0U);
}

TEST_F(CalibrationFile, RefusesAnotherVersion) {
  EXPECT_EQ(line_with("nadir_calibration: 2", "nadir_calibration: 3"),
            "cal.yaml:1:1: calibration of version 3; this nadir reads versions 1 to 2; run "
            "nadir-calibrate again");
}

TEST_F(CalibrationFile, RefusesWhatItDoesNotKnow) {
  EXPECT_THAT(line_with("height_m:", "hight_m:"), HasSubstr("height_m"));
  EXPECT_THAT(line_with("  scale_px:", "  zoom: 1\n  scale_px:"), HasSubstr("zoom"));
  EXPECT_THAT(line_with("height_m: 0.12", "height_m: 0.12\nheight_m: 0.13"), HasSubstr("height_m"));
  EXPECT_THAT(line_with("polynomial2", "homography"), HasSubstr("pinhole"));
  EXPECT_THAT(line_with("polynomial2", "polynomial7"), HasSubstr("polynomial7"));
  EXPECT_THAT(line_with("height_m: 0.12", "height_m: -1"), HasSubstr("cal.yaml:3:11"));
  EXPECT_THAT(line_with("image_height_px: 962\n", ""), HasSubstr("image_height_px"));
}

TEST_F(CalibrationFile, RefusesWhatIsNoCovariance) {
  EXPECT_THAT(line_with("    - {row: [", "    - {row: [-"), HasSubstr("is no covariance"));
  const Calibration written = example();
  const std::string text = calibration_yaml(written);
  const std::size_t last_row = text.rfind("    - {row");
  const std::size_t after_it = text.find('\n', last_row) + 1;
  const auto file = folder_.write("cal.yaml", text.substr(0, last_row) + text.substr(after_it));
  EXPECT_THAT(input_error_line([&] { load_calibration(file); }),
              HasSubstr("has 5 rows; 6 are needed"));
}

TEST_F(CalibrationFile, RefusesWhatIsNoLackOfFit) {
  EXPECT_THAT(line_with("    columns: ", "    columns: 1"), HasSubstr("error_x_m"));
  EXPECT_THAT(line_with("    columns: ", "    columns: -"), HasSubstr("columns"));
  EXPECT_THAT(line_with("    variance_y_m2: [", "    variance_y_m2: [-1, "),
              HasSubstr("variance_y_m2"));
  EXPECT_THAT(line_with("    variance_y_m2: [\n      ", "    variance_y_m2: [\n      -"),
              HasSubstr("variance_y_m2"));
  EXPECT_THAT(line_with("    rows: ", "    depth: 2\n    rows: "), HasSubstr("depth"));
}

TEST_F(CalibrationFile, RefusesAFileThatIsNotThere) {
  EXPECT_THAT(input_error_line([&] { load_calibration(folder_.path() / "none.yaml"); }),
              HasSubstr("none.yaml"));
}

TEST(CalibrationImageSize, MustBeTheStoredOne) {
  const Calibration calibration = example();
  EXPECT_NO_THROW(check_image_size(calibration, "cal.yaml", 1282, 962));
  EXPECT_EQ(input_error_line([&] { check_image_size(calibration, "cal.yaml", 640, 480); }),
            "cal.yaml: made for images of 1282x962, but the image is 640x480; calibrate with "
            "images of this "
            "size");
}

TEST(CalibrationImageSize, MustHoldThePointsWhereItIsNotStored) {
  Calibration calibration = example();
  calibration.image_width_px = calibration.image_height_px = 0;
  calibration.points_box = {{0.0, 0.0}, {1279.4, 959.4}};
  EXPECT_NO_THROW(check_image_size(calibration, "cal.yaml", 1280, 960));
  EXPECT_NO_THROW(check_image_size(calibration, "cal.yaml", 1920, 1080));
  EXPECT_EQ(input_error_line([&] { check_image_size(calibration, "cal.yaml", 1279, 960); }),
            "cal.yaml: its points reach from (0.0, 0.0) to (1279.4, 959.4) px, but the image is "
            "1279x960; "
            "calibrate with images of this size");
}

}  // namespace
}  // namespace nadir::calibration
