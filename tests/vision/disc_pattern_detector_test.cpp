#include "vision/disc_pattern_detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tests/vision/detector_test_scenes.h"
#include "vision/synthetic/random_stream.h"

namespace nadir::vision {
namespace {

constexpr double kScale_px_per_m = 215.0;
constexpr int kHeadings = 24;

MarkerLayout bundled_layout(const std::string& name) {
  return load_marker_layout(std::filesystem::path(NADIR_DATA_DIR) / "layouts" / (name + ".yaml"));
}

MarkerLayout made_up_layout() {
  MarkerLayout layout;
  layout.name = "made up";
  layout.height_m = 0.10;
  layout.centre_radius_m = 0.022;
  layout.teams = {{"leaf", Colour::kGreen}, {"sun", Colour::kYellow}};
  layout.outer = {{{0.055, 0.020}, 0.018, Colour::kPink},
                  {{-0.050, 0.035}, 0.020, Colour::kBlue},
                  {{0.000, -0.060}, 0.016, Colour::kOrange}};
  return layout;
}

double heading_of(const MarkerLayout& layout, const PixelScaleGrid& scale,
                  const RobotObservation& robot) {
  const Eigen::Matrix2d metres_per_pixel = scale.metres_per_pixel(robot.discs[0].centre_px);
  double cosine = 0.0;
  double sine = 0.0;
  for (std::size_t i = 0; i < layout.outer.size(); ++i) {
    const Eigen::Vector2d wanted = layout.outer[i].position_robot_m;
    const Eigen::Vector2d seen =
        metres_per_pixel * (robot.discs[i + 1].centre_px - robot.discs[0].centre_px);
    cosine += wanted.dot(seen);
    sine += wanted.x() * seen.y() - wanted.y() * seen.x();
  }
  return std::atan2(sine, cosine);
}

/// Every placed robot is reported once, where and as what it is, and nothing else.
void expect_exactly(const std::vector<RobotPlacement>& placed, const MarkerLayout& layout,
                    const CameraModel& camera, const PixelScaleGrid& scale,
                    const DetectionResult& result) {
  EXPECT_EQ(result.robots.size(), placed.size());
  for (const RobotPlacement& truth : placed) {
    const PixelPoint centre_px =
        camera.project({truth.motion.x_m, truth.motion.y_m, layout.height_m});
    int found = 0;
    for (const RobotObservation& robot : result.robots) {
      if ((robot.discs[0].centre_px - centre_px).norm() > 1.0) continue;
      ++found;
      EXPECT_EQ(robot.team, static_cast<int>(truth.team));
      if (!layout.is_anonymous()) {
        ASSERT_GE(robot.identity, 0);
        EXPECT_EQ(layout.identities[robot.identity].id, truth.id);
      }
      const double error_rad =
          std::remainder(heading_of(layout, scale, robot) - truth.motion.heading_rad, 2.0 * M_PI);
      EXPECT_LT(std::abs(error_rad), 0.03);
    }
    EXPECT_EQ(found, 1) << "team " << truth.team << " id " << truth.id << " heading "
                        << truth.motion.heading_rad << " at " << centre_px.transpose();
  }
}

/// Robots in rows, each at another heading and sub-pixel place.
std::vector<RobotPlacement> one_of_each_heading(const CameraModel& camera,
                                                const MarkerLayout& layout, std::size_t team,
                                                int id, RandomStream& random) {
  std::vector<RobotPlacement> robots;
  for (int i = 0; i < kHeadings; ++i) {
    const PixelPoint place(40.0 + 50.0 * (i % 6) + random.uniform(),
                           40.0 + 50.0 * (i / 6) + random.uniform());
    const double heading_rad = 2.0 * M_PI * (i + random.uniform()) / kHeadings;
    robots.push_back(robot_at(camera, layout, place, heading_rad, team, id));
  }
  return robots;
}

TEST(DiscPatternDetector, ReadsEveryIdentityOfBothTeamsAtEveryHeading) {
  const MarkerLayout layout = bundled_layout("league");
  Scene scene = straight_scene(layout, 340, 240, kScale_px_per_m);
  scene.sensor.noise = true;
  Renderer renderer(scene, 1);
  const PixelScaleGrid scale = scale_of(renderer.camera(), layout.height_m);
  DiscPatternDetector detector(layout, scale);
  RandomStream random(1);
  DetectionResult result;
  cv::Mat bgr;
  for (std::size_t team = 0; team < 2; ++team) {
    for (int id = 0; id < 16; ++id) {
      SCOPED_TRACE(testing::Message() << "team " << team << " id " << id);
      const auto robots = one_of_each_heading(renderer.camera(), layout, team, id, random);
      renderer.render_robots(id, robots, bgr);
      detector.detect(bgr, result);
      expect_exactly(robots, layout, renderer.camera(), scale, result);
    }
  }
}

// Headings half way between two of those that are tried, seen by a Bayer sensor from so near that
// each disc's rim is far from its middle: the worst start for the outer discs.
TEST(DiscPatternDetector, FindsHeadingsBetweenThoseThatItTries) {
  const MarkerLayout layout = bundled_layout("league");
  Scene scene = straight_scene(layout, 640, 480, 2.0 * kScale_px_per_m);
  scene.sensor.noise = true;
  scene.sensor.mosaic = SceneSensor::Mosaic::kRggb;
  scene.light.level = 0.45;
  Renderer renderer(scene, 6);
  const PixelScaleGrid scale = scale_of(renderer.camera(), layout.height_m);
  DiscPatternDetector detector(layout, scale);
  RandomStream random(6);
  DetectionResult result;
  cv::Mat bgr;
  for (int i = 0; i < 16; ++i) {
    std::vector<RobotPlacement> robots;
    for (int k = 0; k < kHeadings; ++k) {
      const PixelPoint place(60.0 + 100.0 * (k % 6) + random.uniform(),
                             60.0 + 110.0 * (k / 6) + random.uniform());
      robots.push_back(robot_at(renderer.camera(), layout, place,
                                2.0 * M_PI * (k + 0.5 + random.uniform(-0.05, 0.05)) / kHeadings,
                                random.below(2), i));
    }
    renderer.render_robots(i, robots, bgr);
    detector.detect(bgr, result);
    expect_exactly(robots, layout, renderer.camera(), scale, result);
  }
}

class EveryLayout : public testing::TestWithParam<const char*> {
 protected:
  EveryLayout()
      : layout_(std::string(GetParam()) == "made_up" ? made_up_layout()
                                                     : bundled_layout(GetParam())),
        scene_(straight_scene(layout_, 340, 240, kScale_px_per_m)) {
    scene_.sensor.noise = true;
  }
  void expect_all_found() {
    Renderer renderer(scene_, 2);
    const PixelScaleGrid scale = scale_of(renderer.camera(), layout_.height_m);
    DiscPatternDetector detector(layout_, scale);
    RandomStream random(2);
    DetectionResult result;
    cv::Mat bgr;
    for (std::size_t team = 0; team < layout_.teams.size(); ++team) {
      for (int round = 0; round < 4; ++round) {
        const auto robots =
            one_of_each_heading(renderer.camera(), layout_, team, 3 * round, random);
        renderer.render_robots(round, robots, bgr);
        detector.detect(bgr, result);
        expect_exactly(robots, layout_, renderer.camera(), scale, result);
      }
    }
  }
  MarkerLayout layout_;
  Scene scene_;
};
INSTANTIATE_TEST_SUITE_P(Layouts, EveryLayout,
                         testing::Values("league", "pair", "triangle", "made_up"));

TEST_P(EveryLayout, IsFoundAtEveryHeading) { expect_all_found(); }

TEST_P(EveryLayout, IsFoundByATurnedCamera) {
  for (const double pan_rad : {0.7, 2.4, -1.9}) {
    scene_.camera.pan_rad = pan_rad;
    SCOPED_TRACE(pan_rad);
    expect_all_found();
  }
}

TEST_P(EveryLayout, IsFoundByATiltedCamera) {
  scene_.camera.tilt_rad = 0.3;
  scene_.camera.tilt_direction_rad = 0.9;
  expect_all_found();
}

// A picture that was flipped on its way, with a calibration made from such pictures.
TEST_P(EveryLayout, IsFoundInAMirroredPicture) {
  Renderer renderer(scene_, 3);
  const CameraModel& camera = renderer.camera();
  const int width_px = camera.width_px();
  const Eigen::Matrix2d straight = camera.pixels_per_metre({0.0, 0.0, layout_.height_m});
  Eigen::Matrix2d mirrored = straight;
  mirrored.row(0) *= -1.0;
  ASSERT_LT(straight.determinant(), 0.0);
  ASSERT_GT(mirrored.determinant(), 0.0);
  const Eigen::Matrix2d metres_per_pixel = mirrored.inverse();
  const PixelScaleGrid scale(width_px, camera.height_px(),
                             [&](const PixelPoint&) { return metres_per_pixel; });
  DiscPatternDetector detector(layout_, scale);
  RandomStream random(3);
  const auto robots = one_of_each_heading(camera, layout_, 0, 6, random);
  cv::Mat bgr;
  renderer.render_robots(0, robots, bgr);
  cv::flip(bgr, bgr, 1);
  DetectionResult result;
  detector.detect(bgr, result);
  for (RobotObservation& robot : result.robots) {
    for (int i = 0; i < robot.disc_count; ++i) {
      robot.discs[i].centre_px.x() = width_px - 1.0 - robot.discs[i].centre_px.x();
    }
  }
  expect_exactly(robots, layout_, camera, scale_of(camera, layout_.height_m), result);
}

// Plates that touch, in any direction and heading; fronts that touch, as close as robots can be.
TEST(DiscPatternDetector, TellsTouchingRobotsApart) {
  const MarkerLayout layout = bundled_layout("league");
  Renderer renderer(straight_scene(layout, 160, 160, kScale_px_per_m), 4);
  const PixelScaleGrid scale = scale_of(renderer.camera(), layout.height_m);
  DiscPatternDetector detector(layout, scale);
  RandomStream random(4);
  DetectionResult result;
  cv::Mat bgr;
  for (int i = 0; i < 600; ++i) {
    const double direction_rad = random.uniform(0.0, 2.0 * M_PI);
    const bool fronts = i % 3 == 0;
    const double apart_px = kScale_px_per_m * (fronts ? 0.131 : 0.180);
    const PixelPoint first(50.0 + 60.0 * random.uniform(), 50.0 + 60.0 * random.uniform());
    const PixelPoint second =
        first + apart_px * PixelPoint(std::cos(direction_rad), -std::sin(direction_rad));
    if (second.minCoeff() < 22.0 || second.maxCoeff() > 138.0) continue;
    const double heading_rad = fronts ? direction_rad : random.uniform(0.0, 2.0 * M_PI);
    const std::vector<RobotPlacement> robots = {
        robot_at(renderer.camera(), layout, first, heading_rad, random.below(2),
                 static_cast<int>(random.below(16))),
        robot_at(renderer.camera(), layout, second,
                 fronts ? heading_rad + M_PI : random.uniform(0.0, 2.0 * M_PI), random.below(2),
                 static_cast<int>(random.below(16)))};
    renderer.render_robots(i, robots, bgr);
    detector.detect(bgr, result);
    expect_exactly(robots, layout, renderer.camera(), scale, result);
  }
}

// Balls and other round things in all colours of the game around a robot, touching its plate.
TEST(DiscPatternDetector, ClutterNextToARobotNeitherHidesNorMakesOne) {
  const MarkerLayout layout = bundled_layout("league");
  RandomStream random(5);
  DetectionResult result;
  cv::Mat bgr;
  for (int i = 0; i < 60; ++i) {
    Scene scene = straight_scene(layout, 200, 200, kScale_px_per_m);
    for (int k = 0; k < 9; ++k) {
      const double angle_rad = 2.0 * M_PI * k / 9.0 + random.uniform(0.0, 0.3);
      const double distance_m = 0.09 + 0.0215 + random.uniform(0.001, 0.02);
      const Colour colours[] = {Colour::kOrange, Colour::kOrange, Colour::kPink, Colour::kGreen,
                                Colour::kBlue,   Colour::kYellow, Colour::kWhite};
      scene.clutter.discs.push_back(
          {.place_m = distance_m * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad)),
           .radius_m = 0.0215,
           .height_m = layout.height_m,
           .colour = colours[random.below(7)]});
    }
    Renderer renderer(scene, 5);
    const PixelScaleGrid scale = scale_of(renderer.camera(), layout.height_m);
    DiscPatternDetector detector(layout, scale);
    const std::vector<RobotPlacement> robots = {robot_at(
        renderer.camera(), layout, {99.0 + random.uniform(), 99.0 + random.uniform()},
        random.uniform(0.0, 2.0 * M_PI), random.below(2), static_cast<int>(random.below(16)))};
    renderer.render_robots(i, robots, bgr);
    detector.detect(bgr, result);
    expect_exactly(robots, layout, renderer.camera(), scale, result);
  }
}

}  // namespace
}  // namespace nadir::vision
