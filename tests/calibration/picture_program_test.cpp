// Calibrations out of pictures, with the program as a user starts it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "calibration/calibration_file.h"
#include "tests/calibration/picture_drawing.h"
#include "tests/support/child_process.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::calibration {
namespace {

using testing::HasSubstr;
using Words = std::vector<std::string>;

const cv::Size kSize(400, 300);

/// 5 mm/px, nearly straight down: curved a little, exactly of second order.
Eigen::Vector2d camera(const vision::PixelPoint& pixel) {
  const double u = pixel.x() - 200.0;
  const double v = pixel.y() - 150.0;
  return {0.05 + 5e-3 * u + 2e-4 * v + 4e-7 * u * u, -0.1 + 1e-4 * u - 5.1e-3 * v + 3e-7 * u * v};
}

struct Outcome {
  int code = -1;
  std::string out;
  std::string err;
};

Outcome run(const char* program, const Words& arguments) {
  test::ChildProcess child(program, arguments);
  const auto code = child.wait(std::chrono::seconds(100));
  return {code.value_or(-1), child.out(), child.err()};
}

/// Largest distance of a calibration from the true camera over the inner part of the picture.
double worst_error_m(const std::string& file) {
  const Calibration calibration = load_calibration(file);
  double worst = 0.0;
  for (double u = 80; u <= 320; u += 40) {
    for (double v = 60; v <= 240; v += 30) {
      worst = std::max(worst, (calibration.map.plane_from_pixel({u, v}) - camera({u, v})).norm());
    }
  }
  return worst;
}

class Pictures : public testing::Test {
 protected:
  Pictures() : output_(folder_.path() / "cal.yaml") {}

  std::string picture_folder(const std::string& name, const Shade& shade, int count,
                             std::uint64_t seed) const {
    const auto path = folder_.path() / name;
    std::filesystem::create_directories(path);
    for (int i = 0; i < count; ++i) {
      write_png(path / ("picture" + std::to_string(i) + ".png"),
                drawn_picture(kSize, camera, shade, seed + static_cast<std::uint64_t>(i)));
    }
    return path;
  }

  static void expect_refusal(const Outcome& outcome, const std::string& words) {
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(words));
  }

  vision::ScratchFolder folder_;
  std::string output_;
};

/// Tags from `first_id` on, at columns x rows places of the field.
std::vector<DrawnTag> tag_grid(int first_id, int columns, int rows, double shift_m) {
  std::vector<DrawnTag> placed;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      placed.push_back({first_id + static_cast<int>(placed.size()),
                        {-0.75 + shift_m + 1.6 * column / (columns - 1),
                         -0.68 + shift_m + 1.2 * row / (rows - 1)}});
    }
  }
  return placed;
}

std::string tag_file(const std::vector<DrawnTag>& placed) {
  std::ostringstream yaml;
  yaml << "tags:\n";
  for (const DrawnTag& tag : placed) {
    yaml << "  " << tag.id << ": [" << tag.place_m.x() << ", " << tag.place_m.y() << "]\n";
  }
  return yaml.str();
}

TEST_F(Pictures, OfTagsMakeACalibrationAndJudgeIt) {
  const auto placed = tag_grid(0, 6, 5, 0.0);
  const std::string pictures = picture_folder("tags", tags(placed, 0.12), 2, 31);
  const std::string survey = folder_.write("tags.yaml", tag_file(placed));
  const std::string points = folder_.path() / "points.csv";
  const Outcome outcome =
      run(NADIR_CALIBRATE, {"field", pictures, "--tags", survey, "--height", "0", "--pixel-noise",
                            "0.05", "-o", output_, "--save-points", points});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_LT(worst_error_m(output_), 0.001);  // a fifth of a pixel
  const Calibration calibration = load_calibration(output_);
  EXPECT_EQ(calibration.image_width_px, kSize.width);
  EXPECT_EQ(calibration.residuals.points, 30);
  EXPECT_EQ(load_field_points(points).points.size(), 30U);

  const auto others = tag_grid(100, 4, 3, 0.05);
  const std::string other_survey = folder_.write("others.yaml", tag_file(others));
  const Outcome judged = run(
      NADIR_CALIBRATE, {"validate", output_, picture_folder("others", tags(others, 0.12), 1, 41),
                        "--tags", other_survey});
  ASSERT_EQ(judged.code, 0) << judged.err;
  const auto json = nlohmann::json::parse(judged.out);
  EXPECT_EQ(json.at("points"), 12);
  EXPECT_LT(json.at("rms_m").get<double>(), 0.001);
}

TEST_F(Pictures, OfACheckerboardMakeACalibration) {
  constexpr double kSquare_m = 0.15;
  const Eigen::Vector2d origin_m(-0.55, -0.6);
  const std::string pictures =
      picture_folder("board", checkerboard(origin_m, 0.0, kSquare_m, 9, 7), 1, 51);
  Words arguments = {
      "field",    pictures,       "--checkerboard",  "9x7",         "--square", "0.15",
      "--origin", "-0.55,-0.6,0", "--origin-corner", "bottom-left", "--height", "0",
      "-o",       output_};
  ASSERT_EQ(run(NADIR_CALIBRATE, arguments).code, 0);
  EXPECT_EQ(load_calibration(output_).residuals.points, 63);
  EXPECT_LT(worst_error_m(output_), 0.001);

  // The same board told by its opposite corner, from where its columns run the other way.
  arguments[7] = "0.65,0.3,180";
  arguments[9] = "top-right";
  ASSERT_EQ(run(NADIR_CALIBRATE, arguments).code, 0);
  EXPECT_LT(worst_error_m(output_), 0.001);
}

TEST_F(Pictures, OfARobotAtSurveyedPlacesMakeACalibration) {
  const std::string layout = std::string(NADIR_DATA_DIR) + "/layouts/pair.yaml";
  const std::string scene =
      folder_.write("scene.yaml",
                    "camera: {width_px: 400, height_px: 300, height_m: 2.5, pixels_per_metre: 200, "
                    "tilt_deg: 0, k1: 0}\nfloor: {colour: [0.46, 0.44, 0.40]}\n"
                    "random_robots:\n  - {layout: " +
                        layout +
                        ", count: 1}\n"
                        "points: {columns: 5, rows: 4, height_m: 0.12}\n");
  const std::string recording = folder_.path() / "robot";
  ASSERT_EQ(run(NADIR_RENDER, {scene, "-o", recording, "--frames", "24", "--seed", "2"}).code, 0);
  std::ifstream truth(recording + "/truth.jsonl");
  std::string markers = "file,x_m,y_m\n";
  int frame = 0;
  for (std::string line; std::getline(truth, line); ++frame) {
    const auto robot = nlohmann::json::parse(line).at("robots").at(0);
    std::ostringstream row;
    row << (frame < 10 ? "00000" : "0000") << frame << ".png," << robot.at("x_m") << ","
        << robot.at("y_m") << "\n";
    markers += row.str();
  }
  const std::string survey = folder_.write("markers.csv", markers);
  const Outcome outcome =
      run(NADIR_CALIBRATE, {"field", recording + "/frames", "--markers", survey, "--layout", layout,
                            "--height", "0.12", "-o", output_});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(load_calibration(output_).residuals.points, 24);
  // Points that the renderer surveyed, and nobody looked for in a picture.
  const Outcome judged = run(NADIR_CALIBRATE, {"validate", output_, recording + "/points.csv"});
  EXPECT_LT(nlohmann::json::parse(judged.out).at("rms_m").get<double>(), 0.002) << judged.err;
}

TEST_F(Pictures, AreRefusedWithOneLineWhereTheyCannotWork) {
  const auto blank = [](const Eigen::Vector2d&) { return 120.0; };
  const std::string pictures = picture_folder("blank", blank, 1, 61);
  const std::string survey = folder_.write("tags.yaml", "tags: {0: [0, 0]}\n");
  const auto field = [&](const std::string& points, const Words& more) {
    Words arguments = {"field", points, "--height", "0", "-o", output_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(NADIR_CALIBRATE, arguments);
  };
  expect_refusal(field(pictures, {}), "is a folder, but what lies in its pictures is not said");
  expect_refusal(field(survey, {"--tags", survey}), "is no folder of pictures");
  expect_refusal(field(pictures, {"--tags", survey}), "show none of the 1 tags of");
  expect_refusal(field(pictures, {"--checkerboard", "9x7"}), "--square");
  const Words board = {"--square", "0.1", "--origin", "0,0,0", "--origin-corner", "top-left"};
  Words small = board;
  small.insert(small.end(), {"--checkerboard", "2x7"});
  expect_refusal(field(pictures, small), "--checkerboard is '2x7'");
  Words absent = board;
  absent.insert(absent.end(), {"--checkerboard", "9x7"});
  expect_refusal(field(pictures, absent), "show no board of 9x7 inner corners");
  const std::string wrong = folder_.write("wrong.yaml", "family: tag99\ntags: {0: [0, 0]}\n");
  expect_refusal(field(pictures, {"--tags", wrong}), "wrong.yaml:1:");
  const auto empty = folder_.path() / "empty";
  std::filesystem::create_directories(empty);
  expect_refusal(field(empty, {"--tags", survey}), "holds no picture");
  const std::string markers = folder_.write("markers.csv", "file,x_m,y_m\nnone.png,0,0\n");
  expect_refusal(field(pictures, {"--markers", markers, "--layout",
                                  std::string(NADIR_DATA_DIR) + "/layouts/pair.yaml"}),
                 "markers.csv:2:1: there is no picture 'none.png' in the folder");
  EXPECT_FALSE(std::filesystem::exists(output_));
}

TEST_F(Pictures, ATagThatMovedIsNamed) {
  const std::string pictures = picture_folder("still", tags({{5, {0.0, 0.0}}}, 0.12), 1, 71);
  write_png(pictures + "/later.png",
            drawn_picture(kSize, camera, tags({{5, {0.1, 0.0}}}, 0.12), 72));
  const std::string survey = folder_.write("tags.yaml", "tags: {5: [0, 0]}\n");
  expect_refusal(
      run(NADIR_CALIBRATE, {"field", pictures, "--tags", survey, "--height", "0", "-o", output_}),
      "tag 5 is at u");
}

}  // namespace
}  // namespace nadir::calibration
