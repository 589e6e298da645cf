// The program itself: exit codes, what goes to stdout and what to stderr.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "calibration/calibration_file.h"
#include "tests/calibration/synthetic_points.h"
#include "tests/support/child_process.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::calibration {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string csv(const FieldPoints& points) {
  std::string text = "u_px,v_px,x_m,y_m\n";
  for (const FieldPoint& point : points.points) {
    for (const double number : {point.pixel.x(), point.pixel.y(), point.position_m.x()}) {
      text += std::to_string(number) + ",";
    }
    text += std::to_string(point.position_m.y()) + "\n";
  }
  return text;
}

struct Outcome {
  int code = -1;
  std::string out;
  std::string err;
};

class CalibrateCommand : public testing::Test {
 protected:
  CalibrateCommand() {
    std::mt19937_64 random(61);
    const auto points = with_noise(grid_points(7, 6, quadratic_truth), 0.2, 0.0, random);
    points_ = folder_.write("points.csv", csv(points));
    output_ = folder_.path() / "cal.yaml";
  }

  static Outcome run(const std::vector<std::string>& arguments) {
    test::ChildProcess child(NADIR_CALIBRATE, arguments);
    const auto code = child.wait(std::chrono::seconds(60));
    return {code.value_or(-1), child.out(), child.err()};
  }
  Outcome field(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"field", points_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  /// Exit code 2, nothing on stdout, one line on stderr that holds `words`.
  static void expect_refusal(const Outcome& outcome, const std::string& words) {
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_THAT(outcome.err, StartsWith("nadir-calibrate: "));
    EXPECT_THAT(outcome.err, HasSubstr(words));
  }

  vision::ScratchFolder folder_;
  std::string points_;
  std::string output_;
};

TEST_F(CalibrateCommand, FieldWritesACalibration) {
  const Outcome outcome = field({"--model", "polynomial2", "--height", "0.12", "-o", output_,
                                 "--pixel-noise", "0.2", "--image-size", "1290x970"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("RMS"));
  const Calibration calibration = load_calibration(output_);
  EXPECT_DOUBLE_EQ(calibration.height_m, 0.12);
  EXPECT_EQ(calibration.image_width_px, 1290);
  EXPECT_EQ(calibration.noise.pixel_px, 0.2);
  EXPECT_LT((calibration.map.plane_from_pixel({640, 480}) - quadratic_truth({640, 480})).norm(),
            5e-4);
}

TEST_F(CalibrateCommand, FieldWritesToStdoutAndJsonToAFile) {
  const std::string json_file = folder_.path() / "fit.json";
  const Outcome outcome = field({"--height", "0", "-o", "-", "--json", json_file});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith("nadir_calibration: 2\n"));
  std::ifstream stream(json_file);
  const auto json = nlohmann::json::parse(stream);
  const Calibration calibration = load_calibration(folder_.write("out.yaml", outcome.out));
  EXPECT_EQ(json.at("points"), 42);
  EXPECT_EQ(json.at("rms_m"), calibration.residuals.rms_m);
  EXPECT_EQ(json.at("max_px"), calibration.residuals.max_px);
  EXPECT_TRUE(json.at("explained_rms_m").is_null());
  EXPECT_EQ(json.at("worst").size(), 3U);
  EXPECT_THAT(json.at("remarks").at(0).get<std::string>(), StartsWith("no noise is stated"));
}

TEST_F(CalibrateCommand, FieldFitsEveryModelAndTheBest) {
  for (const char* model :
       {"polynomial3", "polynomial4", "homography", "radial", "radial2", "auto"}) {
    const Outcome outcome =
        field({"--height", "0", "-o", output_, "--model", model, "--pixel-noise", "0.2"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const std::string expected = model == std::string("auto") ? "polynomial2" : model;
    EXPECT_EQ(model_name(load_calibration(output_).map.kind()), expected);
    EXPECT_THAT(outcome.err, HasSubstr(expected + " on 42 points"));
  }
}

TEST_F(CalibrateCommand, FieldWritesNothingForWrongPointsUnlessForced) {
  std::mt19937_64 random(62);
  FieldPoints points = with_noise(grid_points(8, 7, quadratic_truth), 0.2, 0.0, random);
  points.points[10].position_m.y() -= 0.1;
  const std::string wrong = folder_.write("wrong.csv", csv(points));
  const std::string json_file = folder_.path() / "wrong.json";
  std::vector<std::string> arguments = {
      "field", wrong, "--height", "0", "--json", json_file, "-o", output_, "--pixel-noise", "0.2"};
  const Outcome refused = run(arguments);
  EXPECT_EQ(refused.code, 1);
  EXPECT_FALSE(std::filesystem::exists(output_));
  EXPECT_THAT(refused.err, StartsWith("FAIL: polynomial2 on 56 points"));
  EXPECT_THAT(refused.err, HasSubstr("FAIL: line 12: y_m is 1"));
  EXPECT_THAT(refused.err, HasSubstr("is not written; correct the points, or insist with --force"));
  std::ifstream stream(json_file);
  const auto json = nlohmann::json::parse(stream);
  EXPECT_EQ(json.at("grade"), "FAIL");
  EXPECT_EQ(json.at("findings").at(0).at("lines").at(0), 12);
  arguments.emplace_back("--force");
  EXPECT_EQ(run(arguments).code, 0);
  EXPECT_TRUE(std::filesystem::exists(output_));
}

TEST_F(CalibrateCommand, ValidateReportsWhatTheContractSays) {
  ASSERT_EQ(field({"--height", "0.12", "-o", output_, "--pixel-noise", "0.2"}).code, 0);
  const Outcome outcome = run({"validate", output_, points_});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.size(), 5U);
  EXPECT_EQ(json.at("points"), 42);
  EXPECT_NEAR(json.at("rms_m").get<double>(), load_calibration(output_).residuals.rms_m, 1e-6);
  EXPECT_LE(json.at("rms_m"), json.at("p95_m"));
  EXPECT_LE(json.at("p95_m"), json.at("max_m"));
  EXPECT_GT(json.at("coverage95"), 0.85);

  const std::string file = folder_.path() / "validation.json";
  const Outcome to_file = run({"validate", output_, points_, "--json", file});
  EXPECT_EQ(to_file.code, 0) << to_file.err;
  EXPECT_EQ(to_file.out, "");
  std::ifstream stream(file);
  EXPECT_EQ(nlohmann::json::parse(stream), json);
}

TEST_F(CalibrateCommand, RefusesWrongUsageWithOneLine) {
  expect_refusal(run({}), "subcommand");
  expect_refusal(run({"feild"}), "subcommand is required");
  expect_refusal(field({"-o", output_}), "--height");
  expect_refusal(field({"--height", "0.1"}), "--output");
  expect_refusal(field({"--height", "nan", "-o", output_}), "'nan' is not a number from 0 to 100");
  expect_refusal(field({"--height", "-1", "-o", output_}), "--height");
  expect_refusal(field({"--height", "0.1", "-o", output_, "--model", "radiant"}),
                 "'radiant' is none of polynomial2");
  expect_refusal(field({"--height", "0.1", "-o", output_, "--camera-height", "3"}),
                 "--camera-height and --nadir belong together");
  expect_refusal(field({"--height", "4", "-o", output_, "--camera-height", "3", "--nadir", "0,0"}),
                 "--camera-height is not above --height");
  expect_refusal(field({"--height", "0", "-o", output_, "--camera-height", "3", "--nadir", "0;0"}),
                 "--nadir is '0;0'; write it like 1.5,-0.25");
  expect_refusal(field({"--height", "0.1", "-o", output_, "--image-size", "1280"}),
                 "--image-size is '1280'; write it like 1280x1024");
  expect_refusal(field({"--height", "0.1", "-o", "-", "--json", "-"}), "both want stdout");
  EXPECT_FALSE(std::filesystem::exists(output_));
}

TEST_F(CalibrateCommand, RefusesBadInputWithOneLine) {
  const std::string missing = folder_.path() / "none.csv";
  expect_refusal(run({"field", missing, "--height", "0.1", "-o", output_}), "none.csv");
  const std::string bad = folder_.write("bad.csv", "u_px,v_px,x_m,y_m\n1,2,3,4\n1,2,nan,4\n");
  expect_refusal(run({"field", bad, "--height", "0.1", "-o", output_}),
                 "bad.csv:3:5: x_m is 'nan'");
  const std::string bare = folder_.write("bare.csv", "u_px,v_px,x_m,y_m\n");
  expect_refusal(run({"field", bare, "--height", "0.1", "-o", output_}),
                 "bare.csv: holds no points");
  expect_refusal(field({"--height", "0.1", "-o", output_, "--image-size", "640x480"}),
                 "but the image is 640x480");
  expect_refusal(field({"--height", "0.1", "-o", folder_.path() / "no/folder/cal.yaml"}),
                 "cannot be written");
  const std::string old = folder_.write("old.yaml", "nadir_calibration: 0\n");
  expect_refusal(run({"validate", old, points_}),
                 "old.yaml:1:1: calibration of version 0; this nadir reads versions 1 to 2; run "
                 "nadir-calibrate "
                 "again");
}

TEST_F(CalibrateCommand, ExplainsItself) {
  const Outcome version = run({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_THAT(version.out, StartsWith("nadir-calibrate "));
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"field", "--help"}, {"validate", "--help"}}) {
    const Outcome help = run(arguments);
    EXPECT_EQ(help.code, 0);
    EXPECT_THAT(help.out, HasSubstr("Example: nadir-calibrate"));
  }
}

}  // namespace
}  // namespace nadir::calibration
