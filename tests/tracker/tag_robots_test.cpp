// Robots with tags: found, placed, and with covariances that are true.

#include "tracker/tag_robots.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "tests/tracker/tag_scenes.h"

namespace nadir::tracker {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

TagErrors errors_of(TagCamera& camera, int frames) {
  TagRobots robots({{*camera.layout.tags, camera.map, 0}}, camera.renderer.camera().width_px(),
                   camera.renderer.camera().height_px());
  TagErrors errors;
  double places = 0.0;
  double headings = 0.0;
  std::vector<RejectionReport> rejected;
  for (int k = 0; k < frames; ++k) {
    const auto number = static_cast<std::uint64_t>(k);
    vision::Frame frame = frame_of(camera.renderer, number);
    // Robots that jump are newcomers every time.
    frame.capture_time += std::chrono::seconds(k);
    robots.detect(frame);
    robots.locate(rejected);
    const auto truth = camera.renderer.truth(number);
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
      errors.nees += error.dot(robot.pose.covariance.inverse() * error);
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

}  // namespace
}  // namespace nadir::tracker
