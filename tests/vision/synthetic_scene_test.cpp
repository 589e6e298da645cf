#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "vision/input/input_error.h"
#include "vision/synthetic/scene.h"

namespace nadir::vision {
namespace {

const std::filesystem::path kScenes = std::filesystem::path(NADIR_DATA_DIR) / "scenes";

/// A scene file in a folder of its own, beside a copy of the league's layout.
class SceneFile : public testing::Test {
 protected:
  void SetUp() override {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = std::filesystem::path(testing::TempDir()) / ("nadir_scene_" + name);
    std::filesystem::create_directories(folder_);
    std::filesystem::copy_file(std::filesystem::path(NADIR_DATA_DIR) / "layouts" / "league.yaml",
                               folder_ / "league.yaml",
                               std::filesystem::copy_options::overwrite_existing);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Scene load(const std::string& text) {
    std::ofstream(folder_ / "scene.yaml") << text;
    return load_scene(folder_ / "scene.yaml");
  }
  std::string complaint(const std::string& text) {
    try {
      load(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no complaint";
  }
  void expect_complaint(const std::string& text, const std::string& place,
                        const std::string& words) {
    const std::string line = complaint(text);
    EXPECT_NE(line.find("scene.yaml:" + place), std::string::npos) << line;
    EXPECT_NE(line.find(words), std::string::npos) << line;
  }

  std::filesystem::path folder_;
};

TEST_F(SceneFile, EveryKeyHasADefault) {
  const Scene scene = load("frames: 5\n");
  EXPECT_EQ(scene.frames, 5U);
  EXPECT_TRUE(scene.robots.empty());
  EXPECT_EQ(scene.camera.width_px, 1280);
  EXPECT_EQ(scene.sensor.mosaic, SceneSensor::Mosaic::kNone);
  EXPECT_FALSE(scene.light.shadow.has_value());
}

TEST_F(SceneFile, ReadsWhatItSays) {
  const Scene scene = load(
      "camera: {width_px: 640, height_px: 480, height_m: 2.15, pixels_per_metre: 280,"
      " tilt_deg: 2, rate_hz: 50}\n"
      "optics: {point_spread_px: 1.1}\n"
      "sensor: {mosaic: gbrg, exposure_ms: 4}\n"
      "light: {colour: [1.15, 1.0, 0.8], shadow: {random: true}}\n"
      "robots:\n"
      "  - {layout: league.yaml, team: blue, id: 7, body_radius_m: 0.08,"
      " path: {kind: circle, radius_m: 0.5, faces: fixed, spin_degps: 90}}\n");
  EXPECT_NEAR(scene.camera.focal_px, 280.0 * 2.0, 1e-9);
  EXPECT_NEAR(scene.camera.tilt_rad, 2.0 * std::numbers::pi / 180.0, 1e-12);
  EXPECT_EQ(scene.camera.centre_u_px, 319.5);
  EXPECT_EQ(scene.rate_hz, 50.0);
  EXPECT_EQ(scene.point_spread_px, 1.1);
  EXPECT_EQ(scene.sensor.mosaic, SceneSensor::Mosaic::kGbrg);
  EXPECT_NEAR(scene.sensor.exposure_s, 0.004, 1e-12);
  EXPECT_FLOAT_EQ(scene.light.colour[2], 1.15F);  // red is the last of blue, green, red
  EXPECT_TRUE(scene.light.shadow->random);
  ASSERT_EQ(scene.robots.size(), 1U);
  EXPECT_EQ(scene.layouts.front().teams.at(scene.robots[0].team).name, "blue");
  EXPECT_EQ(scene.robots[0].id, 7);
  EXPECT_EQ(scene.bodies.front().radius_m, 0.08);
  EXPECT_NEAR(scene.robots[0].path.spin_radps, std::numbers::pi / 2.0, 1e-12);
  EXPECT_EQ(scene.points.height_m, 0.15);
}

TEST_F(SceneFile, WrongInputIsNamedWithItsPlace) {
  expect_complaint("camera: {widht_px: 640}\n", "1:10", "width_px");
  expect_complaint("light:\n  levl: 0.5\n", "2:3", "level");
  expect_complaint("sensor:\n  mosaic: rgbg\n", "2:11", "did you mean");
  expect_complaint("camera: {focal_px: 500, field_of_view_deg: 60}\n", "1:10", "more than once");
  expect_complaint("camera: {focal_px: 500, k1: -0.3}\n", "1:25", "folds");
  expect_complaint("robots:\n  - {layout: nowhere.yaml}\n", "2:6", "nowhere.yaml");
  expect_complaint("robots:\n  - {layout: league.yaml, team: red}\n", "2:27", "yellow, blue");
  expect_complaint("robots:\n  - {layout: league.yaml, id: 16}\n", "2:27", "no robot 16");
  expect_complaint("robots:\n  - {layout: league.yaml, path: {kind: cirle}}\n", "2:", "circle");
  expect_complaint("robots:\n  - {layout: league.yaml, path: {kind: circle}}\n", "2:", "radius_m");
  expect_complaint(
      "robots:\n  - {layout: league.yaml, path: {kind: waypoints, x_m: [1, 1], y_m: [2, 2]}}\n",
      "2:", "neighbouring");
  expect_complaint("random_robots:\n  - {layout: league.yaml, count: 40}\n", "2:", "only 32");
  expect_complaint("light: {level: -1}\n", "1:", "out of range");
  expect_complaint("frames: 3\nframes: 4\n", "2:1", "frames");
}

TEST_F(SceneFile, LiveRobotsAndDeliveryAreRead) {
  const Scene scene = load(
      "live_robots: {layouts: [league.yaml], hold_ms: 250}\n"
      "delivery: {delay_ms: [60, 100], loss: 0.1, blackouts: [{start_s: 20, length_s: 1}]}\n");
  ASSERT_TRUE(scene.live_robots.has_value());
  EXPECT_EQ(scene.live_robots->layouts, std::vector<std::size_t>{0});
  EXPECT_DOUBLE_EQ(scene.live_robots->hold_s, 0.25);
  EXPECT_EQ(scene.layouts.at(0).name, "league");
  EXPECT_DOUBLE_EQ(scene.delivery.shortest_delay_s, 0.06);
  EXPECT_DOUBLE_EQ(scene.delivery.longest_delay_s, 0.1);
  EXPECT_DOUBLE_EQ(scene.delivery.loss, 0.1);
  ASSERT_EQ(scene.delivery.blackouts.size(), 1U);
  EXPECT_DOUBLE_EQ(scene.delivery.blackouts[0].start_s, 20.0);
  EXPECT_DOUBLE_EQ(scene.delivery.blackouts[0].length_s, 1.0);
  // The points for a calibration are at the height of the live robots' marks.
  EXPECT_EQ(scene.points.height_m, 0.15);
}

TEST_F(SceneFile, WrongLiveRobotsAndDeliveryAreNamedWithTheirPlace) {
  const std::string live = "live_robots: {layouts: [league.yaml]}\n";
  expect_complaint("live_robots: {layouts: []}\n", "1:", "the list is empty");
  expect_complaint("live_robots: {layouts: [nowhere.yaml]}\n", "1:", "nowhere.yaml");
  expect_complaint("live_robots: {layouts: [league.yaml], hold: 3}\n", "1:", "hold_ms");
  expect_complaint("delivery: {loss: 0.1}\n", "1:", "live_robots");
  expect_complaint(live + "delivery: {loss: 1}\n", "2:", "out of range");
  expect_complaint(live + "delivery: {delay_ms: [100, 60]}\n", "2:", "no range");
  expect_complaint(live + "delivery: {delay_ms: [1, 2, 3]}\n", "2:", "no range");
  expect_complaint(live + "delivery: {delay: [1, 2]}\n", "2:", "delay_ms");
  expect_complaint(live + "delivery: {blackouts: [{start_s: 1}]}\n", "2:", "length_s");
}

TEST_F(SceneFile, MissingFileIsAnError) {
  EXPECT_THROW(load_scene(folder_ / "absent.yaml"), InputError);
}

TEST(BundledScenes, AllLoad) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    EXPECT_NO_THROW(load_scene(entry.path())) << entry.path();
    ++scenes;
  }
  EXPECT_GE(scenes, 10);
}

}  // namespace
}  // namespace nadir::vision
