#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <string>

#include "tests/vision/synthetic_test_scenes.h"
#include "vision/input/input_error.h"
#include "vision/synthetic/recording.h"
#include "vision/synthetic/renderer.h"
#include "vision/synthetic/synthetic_source.h"

namespace nadir::vision {
namespace {

const std::filesystem::path kScenes = std::filesystem::path(NADIR_DATA_DIR) / "scenes";

bool same(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF) == 0.0; }

TEST(Renderer, AFrameDependsOnSceneSeedAndNumberOnly) {
  const Scene scene = load_scene(kScenes / "pair_shadow.yaml");
  Renderer sequential(scene, 5);
  cv::Mat third;
  for (int frame = 0; frame < 4; ++frame) sequential.render(frame, third);
  cv::Mat alone;
  Renderer(scene, 5).render(3, alone);
  EXPECT_TRUE(same(third, alone));
  cv::Mat other;
  Renderer(scene, 6).render(3, other);
  EXPECT_FALSE(same(third, other));
  Renderer(scene, 5).render(4, other);
  EXPECT_FALSE(same(third, other));
}

TEST(Renderer, TruthIsWhereThePixelsShowTheDisc) {
  // Blue light: the plate and the yellow disc reflect 15 %, only the blue disc stands out.
  Scene scene = load_scene(kScenes / "pair_even.yaml");
  scene.sensor.noise = false;
  Renderer renderer(scene, 2);
  for (int frame = 0; frame < 20; ++frame) {
    cv::Mat bgr;
    renderer.render(frame, bgr);
    const std::vector<RobotTruth> truth = renderer.truth(frame);
    ASSERT_EQ(truth.size(), 3U);
    for (const RobotTruth& robot : truth) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      const int u0 = static_cast<int>(std::lround(robot.u_px));
      const int v0 = static_cast<int>(std::lround(robot.v_px));
      for (int v = v0 - 12; v <= v0 + 12; ++v) {
        for (int u = u0 - 12; u <= u0 + 12; ++u) {
          if (std::hypot(u - robot.u_px, v - robot.v_px) > 11.0) continue;
          const double weight = bgr.at<cv::Vec3b>(v, u)[0] - 0.15 * 240.0;
          sum += weight * Eigen::Vector3d(u, v, 1.0);
        }
      }
      EXPECT_NEAR(sum.x() / sum.z(), robot.u_px, 0.01);
      EXPECT_NEAR(sum.y() / sum.z(), robot.v_px, 0.01);
      // The yellow disc lies 60 mm ahead.
      const Eigen::Vector3d ahead(robot.x_m + 0.06 * std::cos(robot.heading_rad),
                                  robot.y_m + 0.06 * std::sin(robot.heading_rad), 0.12);
      const PixelPoint yellow = renderer.camera().project(ahead);
      const auto pixel = bgr.at<cv::Vec3b>(static_cast<int>(std::lround(yellow.y())),
                                           static_cast<int>(std::lround(yellow.x())));
      EXPECT_NEAR(pixel[0], 0.15 * 240.0, 2.0);
      EXPECT_NEAR(pixel[1], 0.86 * 240.0, 2.0);
      EXPECT_NEAR(pixel[2], 240.0, 2.0);
    }
  }
}

TEST(Renderer, IdentityIsWrittenInTheOuterDiscs) {
  Scene scene = load_scene(kScenes / "league_even.yaml");
  scene.sensor.noise = false;
  Renderer renderer(scene, 3);
  cv::Mat bgr;
  renderer.render(0, bgr);
  const MarkerLayout& layout = scene.layouts.front();
  const auto colours = printed_reflectances();
  int discs = 0;
  for (const RobotTruth& robot : renderer.truth(0)) {
    const int team = layout.teams[0].name == robot.team ? 0 : 1;
    for (int i = 0; i < layout.disc_count(); ++i) {
      const Disc disc = layout.disc(i, team, robot.id);
      const double c = std::cos(robot.heading_rad);
      const double s = std::sin(robot.heading_rad);
      const Eigen::Vector2d& p = disc.position_robot_m;
      const PixelPoint at = renderer.camera().project(
          {robot.x_m + c * p.x() - s * p.y(), robot.y_m + s * p.x() + c * p.y(), layout.height_m});
      const auto pixel = bgr.at<cv::Vec3b>(static_cast<int>(std::lround(at.y())),
                                           static_cast<int>(std::lround(at.x())));
      const Reflectance& colour = colours[static_cast<std::size_t>(disc.colour)];
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(pixel[k], 240.0 * colour[k], 3.0);
      ++discs;
    }
  }
  EXPECT_EQ(discs, 12 * 5);
}

TEST(Renderer, RandomRobotsAreInTheImageApartAndDistinct) {
  const Renderer renderer(load_scene(kScenes / "league_even.yaml"), 4);
  std::set<int> ids;
  for (int frame = 0; frame < 50; ++frame) {
    const std::vector<RobotTruth> truth = renderer.truth(frame);
    ASSERT_EQ(truth.size(), 12U);
    std::set<std::pair<std::string, int>> names;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      names.insert({truth[i].team, truth[i].id});
      ids.insert(truth[i].id);
      EXPECT_TRUE(renderer.camera().sees({truth[i].u_px, truth[i].v_px}, 18.0));
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GE(std::hypot(truth[i].x_m - truth[j].x_m, truth[i].y_m - truth[j].y_m), 0.19);
      }
    }
    EXPECT_EQ(names.size(), 12U);
  }
  EXPECT_EQ(ids.size(), 16U);
}

TEST(Renderer, LightShadowAndColourScaleTheGround) {
  Scene scene = plain_scene(lone_disc_layout(0.02));
  scene.floor.colour = {0.5F, 0.5F, 0.5F};
  scene.light.level = 0.5;
  scene.light.colour = {0.8F, 1.0F, 1.2F};
  SceneShadow shadow;
  shadow.u_px = 160.0;
  shadow.v_px = 120.0;
  shadow.angle_rad = 0.0;  // along u; the shadow is below
  scene.light.shadow = shadow;
  cv::Mat bgr;
  Renderer(scene, 1).render(0, bgr);
  EXPECT_EQ(bgr.at<cv::Vec3b>(20, 30), cv::Vec3b(48, 60, 72));
  EXPECT_EQ(bgr.at<cv::Vec3b>(220, 30), cv::Vec3b(24, 30, 36));
  EXPECT_EQ(bgr.at<cv::Vec3b>(120, 200), cv::Vec3b(36, 45, 54));
}

TEST(Renderer, FloorLineIsCentredOnItsImage) {
  Scene scene = plain_scene(lone_disc_layout(0.02));
  scene.floor.colour = {0.1F, 0.1F, 0.1F};
  scene.floor.lines.push_back({{0.1234, -2.0}, {0.1234, 2.0}, 0.03});
  cv::Mat bgr;
  Renderer renderer(scene, 1);
  renderer.render(0, bgr);
  double weights = 0.0;
  double sum = 0.0;
  for (int u = 0; u < bgr.cols; ++u) {
    const double weight = bgr.at<cv::Vec3b>(60, u)[1] - 24.0;
    weights += weight;
    sum += weight * u;
  }
  const double expected_px = renderer.camera().project({0.1234, 0.0, 0.0}).x();
  EXPECT_NEAR(sum / weights, expected_px, 0.02);
  // Width times contrast.
  const double per_m = scene.camera.focal_px / 3.0;
  EXPECT_NEAR(weights / (240.0 * 0.85), 0.03 * per_m, 0.05);
}

TEST(Renderer, ShowsPosesThatComeFromOutside) {
  Scene scene = plain_scene(lone_disc_layout(0.03));
  Renderer renderer(scene, 1);
  RobotPlacement robot;
  robot.motion.x_m = 0.2;
  cv::Mat bgr;
  renderer.render_robots(0, std::vector{robot}, bgr);
  const std::vector<RobotTruth> truth = renderer.truth_of(std::vector{robot});
  ASSERT_EQ(truth.size(), 1U);
  EXPECT_NEAR(truth[0].u_px, 159.5 + 0.2 * 250.0, 1e-9);
  EXPECT_EQ(bgr.at<cv::Vec3b>(120, 210), cv::Vec3b(240, 240, 240));
  cv::Mat empty;
  renderer.render(0, empty);
  EXPECT_LT(empty.at<cv::Vec3b>(120, 210)[0], 60);
}

TEST(Renderer, RefusesWhatItCannotShow) {
  const Scene good = plain_scene(lone_disc_layout(0.02));
  Scene scene = good;
  scene.bodies.clear();
  EXPECT_THROW(Renderer(scene, 1), std::invalid_argument);
  scene = good;
  scene.random_robots.push_back({0, {0}, 200, 4.0, 0.3, true});
  EXPECT_THROW(Renderer(scene, 1), std::invalid_argument);
  scene = good;
  scene.robots.push_back({0, 1, 0, {}});
  EXPECT_THROW(Renderer(scene, 1), std::invalid_argument);
}

TEST(SyntheticSource, DeliversTheScenesFramesAndEnds) {
  Scene scene = plain_scene(lone_disc_layout(0.02));
  scene.sensor.noise = true;
  scene.rate_hz = 25.0;
  scene.frames = 3;
  SyntheticSource source(scene, 9);
  EXPECT_FALSE(source.is_live());
  Frame frame;
  for (std::uint64_t number = 0; number < 3; ++number) {
    ASSERT_EQ(source.read(frame).status, ReadStatus::kFrame);
    EXPECT_EQ(frame.number, number);
    EXPECT_EQ(frame.capture_time.time_since_epoch().count(),
              1'700'000'000'000'000'000 + static_cast<std::int64_t>(number) * 40'000'000);
  }
  EXPECT_EQ(source.read(frame).status, ReadStatus::kEnd);
  EXPECT_EQ(source.read(frame).status, ReadStatus::kEnd);
  const cv::Mat last = frame.image.clone();
  source.seek(2);
  ASSERT_EQ(source.read(frame).status, ReadStatus::kFrame);
  EXPECT_TRUE(same(last, frame.image));
}

TEST(SyntheticSource, RefusesASceneThatCannotBeShown) {
  Scene scene = plain_scene(lone_disc_layout(0.02));
  scene.bodies.clear();
  EXPECT_THROW(SyntheticSource(scene, 1), InputError);
}

TEST(SyntheticSource, InRealTimeStampsFramesWithTheWallClock) {
  Scene scene = plain_scene(lone_disc_layout(0.02));
  scene.rate_hz = 500.0;
  SyntheticSource source(scene, 9, SyntheticPace::kRealTime);
  EXPECT_TRUE(source.is_live());
  Frame first;
  Frame second;
  const CaptureTime before = std::chrono::system_clock::now();
  ASSERT_EQ(source.read(first).status, ReadStatus::kFrame);
  ASSERT_EQ(source.read(second).status, ReadStatus::kFrame);
  EXPECT_GE(first.capture_time, before);
  EXPECT_GT(second.number, first.number);
  EXPECT_EQ((second.capture_time - first.capture_time).count(),
            static_cast<std::int64_t>(second.number - first.number) * 2'000'000);
}

TEST(Recording, WritesFramesTimesTruthAndPoints) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "nadir_synthetic_recording";
  std::filesystem::remove_all(folder);
  Scene scene = load_scene(kScenes / "pair_even.yaml");
  Renderer renderer(scene, 8);
  write_recording(renderer, 8, 2, folder, [](std::uint64_t) {});

  cv::Mat expected;
  renderer.render(1, expected);
  EXPECT_TRUE(same(cv::imread((folder / "frames" / "000001.png").string()), expected));
  std::ifstream times(folder / "times.csv");
  std::string line;
  std::getline(times, line);
  EXPECT_EQ(line, "file,capture_ns");
  std::getline(times, line);
  EXPECT_EQ(line, "000000.png,1700000000000000000");
  EXPECT_TRUE(std::filesystem::exists(folder / "frames" / "times.csv"));

  std::ifstream truth(folder / "truth.jsonl");
  int frames = 0;
  while (std::getline(truth, line)) {
    const nlohmann::json entry = nlohmann::json::parse(line);
    EXPECT_EQ(entry.at("frame"), frames);
    EXPECT_EQ(entry.at("robots").size(), 3U);
    const RobotTruth robot = renderer.truth(frames).front();
    EXPECT_EQ(entry.at("robots")[0].at("team"), robot.team);
    EXPECT_NEAR(entry.at("robots")[0].at("x_m"), robot.x_m, 1e-8);
    EXPECT_NEAR(entry.at("robots")[0].at("u_px"), robot.u_px, 1e-5);
    ++frames;
  }
  EXPECT_EQ(frames, 2);

  for (const CalibrationPoint& point : calibration_points(scene, renderer.camera(), 8)) {
    const PixelPoint pixel =
        renderer.camera().project({point.world_m.x(), point.world_m.y(), 0.12});
    EXPECT_LT((pixel - point.pixel).norm(), 1e-9);
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace nadir::vision
