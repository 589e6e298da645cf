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

TEST(TagRobots, ErrorsAreAsLargeAsTheirCovariancesSay) {
  for (const TagLight light : {TagLight::kEven, TagLight::kBayer, TagLight::kDim}) {
    for (const double side_px : {14.0, 18.0, 24.0, 30.0, 42.0, 60.0}) {
      TagCamera camera = tag_camera(side_px, light, 5);
      const TagErrors errors = errors_of(camera, 10);
      const std::string name = std::to_string(static_cast<int>(light)) + ", " +
                               std::to_string(side_px) + " px: " + std::to_string(errors.place_px) +
                               " px, " + std::to_string(errors.heading_deg) + " deg";
      // Eight cells in 14 px are as narrow as a mosaic's period.
      if (side_px > 14.0 || light == TagLight::kEven) {
        EXPECT_EQ(errors.found, errors.shown) << name;
      }
      EXPECT_EQ(errors.wrong, 0) << name;
      EXPECT_GT(errors.nees, 1.5) << name;
      EXPECT_LT(errors.nees, 4.5) << name;
    }
  }
}

}  // namespace
}  // namespace nadir::tracker
