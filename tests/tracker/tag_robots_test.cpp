// Robots with tags: found, placed, and with covariances that are true.

#include "tracker/tag_robots.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <opencv2/imgcodecs.hpp>

#include "tests/tracker/tag_scenes.h"

namespace nadir::tracker {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

// What is done to frames.
struct Spoil {
  double speed_mps = 0.0;
  int jpeg_quality = 0;  // 0: none
};

vision::Frame spoilt_frame(vision::Renderer& renderer, std::uint64_t number, const Spoil& spoil,
                           std::vector<vision::RobotTruth>& truth) {
  vision::Frame frame;
  std::vector<vision::RobotPlacement> placements = renderer.placements(number);
  for (std::size_t i = 0; i < placements.size(); ++i) {
    placements[i].motion.velocity_x_mps = spoil.speed_mps * std::cos(static_cast<double>(i));
    placements[i].motion.velocity_y_mps = spoil.speed_mps * std::sin(static_cast<double>(i));
  }
  renderer.render_robots(number, placements, frame.image);
  truth = renderer.truth_of(placements);
  if (spoil.jpeg_quality > 0) {
    std::vector<std::uint8_t> bytes;
    cv::imencode(".jpg", frame.image, bytes, {cv::IMWRITE_JPEG_QUALITY, spoil.jpeg_quality});
    frame.image = cv::imdecode(bytes, cv::IMREAD_COLOR);
  }
  // Robots that jump are newcomers every time.
  frame.capture_time = renderer.capture_time(number) + std::chrono::seconds(number);
  return frame;
}

TagErrors errors_of(TagCamera& camera, int frames, const TagSettings& settings = {},
                    const Spoil& spoil = {}) {
  TagRobots robots({{*camera.layout.tags, camera.map, 0}}, camera.renderer.camera().width_px(),
                   camera.renderer.camera().height_px(), settings);
  TagErrors errors;
  double places = 0.0;
  double headings = 0.0;
  std::vector<RejectionReport> rejected;
  for (int k = 0; k < frames; ++k) {
    const auto number = static_cast<std::uint64_t>(k);
    std::vector<vision::RobotTruth> truth;
    const vision::Frame frame = spoilt_frame(camera.renderer, number, spoil, truth);
    robots.detect(frame);
    robots.locate(rejected);
    if (k < 3) continue;  // blur and noise are learnt
    errors.shown += static_cast<int>(truth.size());
    for (const TagRobot& robot : robots.robots()) {
      const auto at = std::ranges::find(truth, robot.id, &vision::RobotTruth::id);
      if (at == truth.end()) {
        ++errors.wrong;
        continue;
      }
      const fusion::PlanarPose& pose = robot.pose.pose_world_robot;
      const Eigen::Vector3d error(pose.x_m - at->x_m, pose.y_m - at->y_m,
                                  fusion::wrap_angle(pose.heading_rad - at->heading_rad));
      if (error.head<2>().norm() > camera.layout.tags->size_m) ++errors.wrong;
      ++errors.found;
      const double m_per_px =
          std::sqrt(std::abs(camera.map.jacobian_m_per_px(robot.pose.centre_px).determinant()));
      places += 0.5 * error.head<2>().squaredNorm() / (m_per_px * m_per_px);
      headings += error.z() * error.z();
      const double nees = error.dot(robot.pose.covariance.inverse() * error);
      errors.nees += nees;
      errors.worst_nees = std::max(errors.worst_nees, nees);
    }
  }
  errors.place_px = std::sqrt(places / errors.found);
  errors.heading_deg = kDegrees * std::sqrt(headings / errors.found);
  errors.nees /= errors.found;
  return errors;
}

// Robots that drive: after two frames their tags are aligned, not detected.
TEST(TagRobots, DrivingRobotsAreFollowedAndStayThemselves) {
  const std::string folder = std::string(NADIR_DATA_DIR) + "/scenes/";
  vision::Scene scene = vision::load_scene(folder + "tags_even.yaml");
  const vision::MarkerLayout layout = scene.layouts.front();
  scene.camera.tilt_rad = scene.camera.k1 = 0.0;
  vision::Renderer renderer(scene, 3);
  calibration::FieldPoints points;
  for (const auto& point : vision::calibration_points(scene, renderer.camera(), 3)) {
    points.points.push_back({point.pixel, point.world_m, 0});
  }
  const calibration::PlaneMap map = calibration::fit_polynomial2(points, {}).map;
  TagRobots robots({{*layout.tags, map, 0}}, scene.camera.width_px, scene.camera.height_px);
  std::vector<vision::RobotPlacement> placements = renderer.placements(0);
  std::vector<RejectionReport> rejected;
  for (int k = 0; k < 12; ++k) {
    vision::Frame frame;
    frame.capture_time = renderer.capture_time(static_cast<std::uint64_t>(k));
    for (vision::RobotPlacement& robot : placements) {
      const double speed_mps = 0.03 * static_cast<double>(robot.id % 10);
      robot.motion.x_m += speed_mps / 60.0;
      robot.motion.heading_rad += 2.0 / 60.0;
    }
    renderer.render_robots(static_cast<std::uint64_t>(k), placements, frame.image);
    robots.detect(frame);
    robots.locate(rejected);
    ASSERT_EQ(robots.robots().size(), placements.size()) << k;
    if (k >= 2) {
      EXPECT_EQ(robots.followed(), placements.size()) << k;
    }
    for (const TagRobot& robot : robots.robots()) {
      const auto at = std::ranges::find(placements, robot.id, &vision::RobotPlacement::id);
      ASSERT_NE(at, placements.end());
      const fusion::PlanarPose& pose = robot.pose.pose_world_robot;
      EXPECT_NEAR(pose.x_m, at->motion.x_m, 2e-5) << k;
      EXPECT_NEAR(pose.y_m, at->motion.y_m, 2e-5) << k;
      EXPECT_NEAR(fusion::wrap_angle(pose.heading_rad - at->motion.heading_rad), 0.0, 1e-3);
    }
  }
  EXPECT_TRUE(rejected.empty());
}

TEST(TagRobots, ErrorsAreAsLargeAsTheirCovariancesSay) {
  for (const TagLight light : {TagLight::kEven, TagLight::kBayer, TagLight::kDim}) {
    for (const double side_px : {18.0, 42.0}) {
      TagCamera camera = tag_camera(side_px, light, 5);
      const TagErrors errors = errors_of(camera, 12);
      const std::string name = std::to_string(static_cast<int>(light)) + ", " +
                               std::to_string(side_px) + " px: " + std::to_string(errors.place_px) +
                               " px, " + std::to_string(errors.heading_deg) + " deg";
      EXPECT_EQ(errors.found, errors.shown) << name;
      EXPECT_EQ(errors.wrong, 0) << name;
      EXPECT_GT(errors.nees, 1.4) << name;
      EXPECT_LT(errors.nees, 4.5) << name;
    }
  }
}

// Without alignment, or where it fails, a law of the corners' errors by size and contrast. It holds
// in the mean: libapriltag's errors have heavier tails than a normal distribution's.
TEST(TagRobots, CornersErrAsTheirLawSays) {
  for (const TagLight light : {TagLight::kEven, TagLight::kBayer, TagLight::kDim}) {
    for (const double side_px : {18.0, 42.0}) {
      TagCamera camera = tag_camera(side_px, light, 9);
      const TagErrors errors = errors_of(camera, 12, {.aligned = false});
      const std::string name = std::to_string(static_cast<int>(light)) + ", " +
                               std::to_string(side_px) + " px: " + std::to_string(errors.place_px) +
                               " px, " + std::to_string(errors.heading_deg) + " deg";
      EXPECT_EQ(errors.wrong, 0) << name;
      EXPECT_GT(errors.nees, 1.4) << name;
      EXPECT_LT(errors.nees, 4.5) << name;
    }
  }
}

TEST(TagRobots, SpoiltFramesAreNotBelievedTooMuch) {
  struct Case {
    const char* name;
    std::function<void(vision::Scene&)> change;
    Spoil spoil;
    double least_found = 1.0;
  };
  const std::vector<Case> cases = {
      {"shadow",
       [](vision::Scene& scene) {
         scene.light.shadow = vision::SceneShadow{.u_px = 320.0, .v_px = 256.0, .random = true};
       },
       {},
       0.75},
      {"moving 5 mm",
       [](vision::Scene& scene) { scene.sensor.exposure_s = 0.005; },
       {.speed_mps = 1.0}},
      {"gamma", [](vision::Scene& scene) { scene.sensor.gamma = 1.0 / 0.7; }, {}},
      {"JPEG 80", {}, {.jpeg_quality = 80}}};
  for (const Case& which : cases) {
    TagCamera camera = tag_camera(42.0, TagLight::kEven, 13, which.change);
    const TagErrors errors = errors_of(camera, 10, {}, which.spoil);
    EXPECT_GE(errors.found, which.least_found * errors.shown) << which.name;
    EXPECT_EQ(errors.wrong, 0) << which.name;
    EXPECT_GT(errors.nees, 0.5) << which.name;
    EXPECT_LT(errors.nees, 5.0) << which.name;
    EXPECT_LT(errors.worst_nees, 40.0) << which.name;  // six sigma
  }
}

}  // namespace
}  // namespace nadir::tracker
