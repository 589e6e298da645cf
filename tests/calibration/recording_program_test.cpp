// From a rendered recording to a better tracker, with the programs as a user starts them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "tests/support/child_process.h"
#include "tests/vision/scratch_folder.h"
#include "vision/colour_file.h"

namespace nadir::calibration {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

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

std::vector<Json> json_lines(const std::string& file) {
  std::ifstream stream(file);
  std::vector<Json> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(Json::parse(line));
  return lines;
}

/// What the tracker made of a recording whose truth is known.
struct Score {
  int robots = 0;  ///< in the truth
  int found = 0;   ///< reported under the right name
  int false_names =
      0;              ///< reported under a name that is not in the truth of the frame, or far away
  double nees = 0.0;  ///< mean over those found; 3 if the covariance holds
};

Score score(const std::string& truth_file, const std::string& poses_file) {
  constexpr double kNear_m = 0.05;
  const auto truth = json_lines(truth_file);
  const auto poses = json_lines(poses_file);
  Score score;
  for (std::size_t i = 0; i < truth.size() && i < poses.size(); ++i) {
    score.robots += static_cast<int>(truth[i].at("robots").size());
    for (const Json& seen : poses[i].at("robots")) {
      bool known = false;
      for (const Json& robot : truth[i].at("robots")) {
        if (robot.at("team") != seen.at("team")) continue;
        Eigen::Vector3d error(seen.at("x_m").get<double>() - robot.at("x_m").get<double>(),
                              seen.at("y_m").get<double>() - robot.at("y_m").get<double>(), 0.0);
        if (error.norm() > kNear_m) continue;
        error.z() = std::remainder(
            seen.at("heading_rad").get<double>() - robot.at("heading_rad").get<double>(),
            2.0 * std::numbers::pi);
        Eigen::Matrix3d covariance;
        for (int row = 0; row < 3; ++row) {
          for (int column = 0; column < 3; ++column) {
            covariance(row, column) =
                seen.at("covariance").at(static_cast<std::size_t>(3 * row + column)).get<double>();
          }
        }
        known = true;
        ++score.found;
        score.nees += error.dot(covariance.inverse() * error);
        break;
      }
      score.false_names += known ? 0 : 1;
    }
  }
  if (score.found > 0) score.nees /= score.found;
  return score;
}

class Recording : public testing::Test {
 protected:
  /// A recording of a scene, with a calibration of its own points. Returns its folder.
  std::string record(const std::string& name, const std::string& scene, int frames) const {
    const std::string file = folder_.write(name + ".yaml", scene);
    const std::string path = folder_.path() / name;
    const Outcome outcome =
        run(NADIR_RENDER, {file, "-o", path, "--frames", std::to_string(frames), "--seed", "4"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const Outcome fitted = run(NADIR_CALIBRATE, {"field", path + "/points.csv", "--height", "0.12",
                                                 "-o", path + "/cal.yaml"});
    EXPECT_EQ(fitted.code, 0) << fitted.err;
    return path;
  }

  static std::string layout(const std::string& name) {
    return std::string(NADIR_DATA_DIR) + "/layouts/" + name + ".yaml";
  }

  /// Runs the tracker on it. Returns the pose log.
  static std::string track(const std::string& recording, const std::string& layout_name,
                           const Words& more = {}) {
    const std::string poses = recording + "/poses" + std::to_string(more.size()) + ".jsonl";
    Words arguments = {"--source",
                       recording + "/frames",
                       "--layout",
                       layout(layout_name),
                       "--calibration",
                       recording + "/cal.yaml",
                       "--no-publish",
                       "--pace",
                       "fastest",
                       "--poses",
                       poses};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(NADIR_TRACKER, arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return poses;
  }

  vision::ScratchFolder folder_;
};

/// Robots with two marks that stand, seen by a camera for which a polynomial is exact.
std::string standing_scene(double pixels_per_metre, double level, const std::string& path) {
  std::ostringstream scene;
  scene << "camera: {width_px: 480, height_px: 360, rate_hz: 30, height_m: 2.5, pixels_per_metre: "
        << pixels_per_metre << ", tilt_deg: 0, k1: 0}\n"
        << "light: {level: " << level << "}\n"
        << "floor: {colour: [0.46, 0.44, 0.40], texture: 0.04}\n"
        << "points: {columns: 8, rows: 6, height_m: 0.12}\nrobots:\n";
  const double width_m = 480 / pixels_per_metre;
  const double height_m = 360 / pixels_per_metre;
  for (int i = 0; i < 6; ++i) {
    const double x_m = width_m * ((i % 3 + 0.5) / 3.0 - 0.5) + 0.0007 * i;
    const double y_m = height_m * ((i / 3 + 0.5) / 2.0 - 0.5) + 0.0011 * i;
    scene << "  - {layout: " << NADIR_DATA_DIR << "/layouts/pair.yaml, team: blue, id: " << i
          << ", path: {" << path << ", x_m: " << x_m << ", y_m: " << y_m
          << (path == "kind: static" ? ", heading_deg: " + std::to_string(55 * i) : "") << "}}\n";
  }
  return scene.str();
}

TEST_F(Recording, OfStandingRobotsMakesAnHonestNoiseFile) {
  const std::string near = record("near", standing_scene(300, 1.0, "kind: static"), 40);
  const std::string far = record("far", standing_scene(170, 0.6, "kind: static"), 40);
  const std::string noise = folder_.path() / "noise.yaml";
  const std::string json = folder_.path() / "noise.json";
  const Outcome outcome = run(NADIR_CALIBRATE, {"noise", track(near, "pair"), track(far, "pair"),
                                                "--no-mosaic", "-o", noise, "--json", json});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("law of a mark"));
  std::ifstream stream(json);
  const Json numbers = Json::parse(stream);
  EXPECT_GT(numbers.at("standing").get<int>(), 0.8 * 2 * 6 * 40);
  EXPECT_GE(numbers.at("classes").size(), 2U);

  for (const std::string& recording : {near, far}) {
    const Score with =
        score(recording + "/truth.jsonl", track(recording, "pair", {"--noise", noise}));
    EXPECT_EQ(with.found, with.robots);
    // The errors of six robots that stand are six draws of what the pixel grid does to them; to
    // what standing shows, the file adds what the grid does to detected discs. Aligned ones hardly
    // feel it: for them the file is careful.
    EXPECT_GT(with.nees, 0.8) << recording;
    EXPECT_LT(with.nees, 6.0) << recording;
  }
}

TEST_F(Recording, OfDrivingRobotsIsNoMeasureOfNoise) {
  const std::string drive =
      record("drive", standing_scene(300, 1.0, "kind: circle, radius_m: 0.05, speed_mps: 0.3"), 30);
  const std::string noise = folder_.path() / "noise.yaml";
  const Outcome outcome = run(NADIR_CALIBRATE, {"noise", track(drive, "pair"), "-o", noise});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("poses are of robots that stand, 100 are needed"));
  EXPECT_FALSE(std::filesystem::exists(noise));
}

std::string coloured_scene(double level, double red, double green, double blue) {
  std::ostringstream scene;
  scene << "camera: {width_px: 560, height_px: 420, rate_hz: 30, height_m: 3.0, pixels_per_metre: "
           "240, tilt_deg: 1, k1: -0.002}\nsensor: {mosaic: rggb}\n"
        << "light: {level: " << level << ", colour: [" << red << ", " << green << ", " << blue
        << "], vignette: 0.15, gradient_u: 0.1}\n"
        << "random_robots:\n  - {layout: " << NADIR_DATA_DIR
        << "/layouts/league.yaml, count: 6, minimum_distance_m: 0.22}\n"
        << "points: {columns: 8, rows: 6}\n";
  return scene.str();
}

TEST_F(Recording, InBadLightTellsColoursWithWhichRobotsAreFound) {
  struct Light {
    const char* name;
    double level, red, green, blue;
    double recall_without;  ///< at most, with the built-in colours
  };
  for (const Light& light :
       {Light{"dim warm", 0.25, 1.3, 1.0, 0.6, 0.75}, Light{"red", 0.6, 1.8, 1.0, 0.5, 0.3},
        Light{"green", 0.5, 0.7, 1.4, 0.7, 0.3}}) {
    std::string name = light.name;
    name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
    const std::string recording =
        record(name, coloured_scene(light.level, light.red, light.green, light.blue), 14);
    const std::string colours = recording + "/colours.yaml";
    const std::string picture = recording + "/classified.png";
    // The first four frames teach; recall is of all.
    Words arguments = {"colours", "--layout",  layout("league"), "-o",
                       colours,   "--picture", picture};
    for (int i = 0; i < 4; ++i) {
      arguments.push_back(recording + "/frames/00000" + std::to_string(i) + ".png");
    }
    const Outcome outcome = run(NADIR_CALIBRATE, arguments);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("are nearest to confusion"));
    EXPECT_TRUE(std::filesystem::exists(picture));
    EXPECT_NO_THROW(vision::load_colour_classes(colours));

    const std::string truth = recording + "/truth.jsonl";
    const Score without = score(truth, track(recording, "league"));
    const Score with = score(truth, track(recording, "league", {"--colours", colours}));
    EXPECT_LT(without.found, light.recall_without * without.robots) << light.name;
    EXPECT_GT(with.found, 0.97 * with.robots) << light.name;
    EXPECT_EQ(with.false_names, 0) << light.name;
  }
}

TEST_F(Recording, ColoursRefuseBadInputWithOneLine) {
  const std::string layout_file = layout("league");
  const auto refusal = [&](const Words& arguments) {
    const Outcome outcome = run(NADIR_CALIBRATE, arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    return outcome.err;
  };
  const std::string output = folder_.path() / "colours.yaml";
  const std::string text = folder_.write("text.png", "no picture");
  EXPECT_THAT(refusal({"colours", text, "--layout", layout_file, "-o", output}),
              HasSubstr("text.png: is damaged or not an image"));
  EXPECT_THAT(refusal({"colours", "--layout", layout_file, "-o", output}), HasSubstr("images"));
  const std::string empty =
      record("empty",
             "camera: {width_px: 160, height_px: 120, pixels_per_metre: 120}\nfloor: {}\n"
             "points: {columns: 4, rows: 4}\n",
             1);
  EXPECT_THAT(
      refusal({"colours", empty + "/frames/000000.png", "--layout", layout_file, "-o", output}),
      HasSubstr("no robot of layout 'league' is seen"));
  EXPECT_FALSE(std::filesystem::exists(output));
}

}  // namespace
}  // namespace nadir::calibration
