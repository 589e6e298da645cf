#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "vision/synthetic/camera_model.h"
#include "vision/synthetic/local_plane_map.h"
#include "vision/synthetic/random_stream.h"
#include "vision/synthetic/robot_path.h"

namespace nadir::vision {
namespace {

CameraParameters wide_tilted_camera() {
  CameraParameters camera;
  camera.width_px = 1280;
  camera.height_px = 960;
  camera.focal_px = 700.0;
  camera.centre_u_px = 650.0;
  camera.centre_v_px = 470.0;
  camera.x_m = 0.3;
  camera.y_m = -0.2;
  camera.height_m = 3.0;
  camera.tilt_rad = 0.12;
  camera.tilt_direction_rad = 2.0;
  camera.pan_rad = 0.7;
  camera.k1 = -0.2;
  camera.k2 = 0.03;
  return camera;
}

TEST(CameraModel, LooksStraightDownWithXToTheRightAndYUp) {
  CameraParameters parameters;
  parameters.focal_px = 1200.0;
  parameters.height_m = 6.0;
  parameters.x_m = 1.0;
  parameters.y_m = 2.0;
  const CameraModel camera(parameters);
  // Similar triangles: 1200 px / (6.0 - 0.15) m.
  const double per_m = 1200.0 / 5.85;
  const PixelPoint pixel = camera.project({1.5, 2.25, 0.15});
  EXPECT_NEAR(pixel.x(), 639.5 + 0.5 * per_m, 1e-10);
  EXPECT_NEAR(pixel.y(), 511.5 - 0.25 * per_m, 1e-10);
}

TEST(CameraModel, TiltMovesTheOpticalAxisInItsDirection) {
  CameraParameters parameters;
  parameters.tilt_rad = 0.1;
  parameters.tilt_direction_rad = 0.5;
  parameters.pan_rad = 1.0;
  const CameraModel camera(parameters);
  const Eigen::Vector2d seen = camera.on_plane({639.5, 511.5}, 0.0);
  const double away_m = parameters.height_m * std::tan(0.1);
  EXPECT_NEAR(seen.x(), away_m * std::cos(0.5), 1e-12);
  EXPECT_NEAR(seen.y(), away_m * std::sin(0.5), 1e-12);
}

TEST(CameraModel, PanTurnsTheImageAgainstTheField) {
  CameraParameters parameters;
  parameters.pan_rad = std::numbers::pi / 2.0;
  const CameraModel camera(parameters);
  // The camera turned counter-clockwise: its right side now shows the world's +y.
  const PixelPoint pixel = camera.project({0.0, 1.0, 0.0});
  EXPECT_GT(pixel.x(), 700.0);
  EXPECT_NEAR(pixel.y(), 511.5, 1e-9);
}

TEST(CameraModel, RadialDistortionFollowsItsDefinition) {
  CameraParameters parameters;
  parameters.k1 = -0.1;
  parameters.k2 = 0.02;
  const CameraModel camera(parameters);
  const double r = 2.0 / 6.0;  // 2 m aside on the field, 6 m below
  const double expected = parameters.focal_px * r * (1.0 - 0.1 * r * r + 0.02 * r * r * r * r);
  EXPECT_NEAR(camera.project({2.0, 0.0, 0.0}).x(), 639.5 + expected, 1e-10);
}

TEST(CameraModel, InverseIsExactOverTheWholeImage) {
  const CameraModel camera(wide_tilted_camera());
  double worst_px = 0.0;
  for (double v = 0.0; v < 960.0; v += 53.3) {
    for (double u = 0.0; u < 1280.0; u += 53.3) {
      for (const double height_m : {0.0, 0.15, 1.0}) {
        const Eigen::Vector2d place = camera.on_plane({u, v}, height_m);
        const PixelPoint back = camera.project({place.x(), place.y(), height_m});
        worst_px = std::max(worst_px, (back - PixelPoint(u, v)).norm());
      }
    }
  }
  EXPECT_LT(worst_px, 1e-9);
}

TEST(CameraModel, JacobianAgreesWithDifferences) {
  const CameraModel camera(wide_tilted_camera());
  for (const Eigen::Vector3d& point :
       {Eigen::Vector3d(0.3, 0.4, 0.1), {-1.5, 1.0, 0.0}, {1.8, -1.2, 0.15}}) {
    const double step = 1e-6;
    Eigen::Matrix2d numeric;
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector3d shift = step * Eigen::Vector3d::Unit(axis);
      numeric.col(axis) =
          (camera.project(point + shift) - camera.project(point - shift)) / (2.0 * step);
    }
    EXPECT_LT((camera.pixels_per_metre(point) - numeric).norm(), 1e-5);
  }
}

TEST(CameraModel, PointsBehindItHaveNoImage) {
  const CameraModel camera{CameraParameters{}};
  EXPECT_TRUE(std::isnan(camera.project({0.0, 0.0, 7.0}).x()));
  EXPECT_TRUE(std::isnan(camera.on_plane({10.0, 10.0}, 7.0).x()));
}

TEST(CameraModel, RefusesALensThatFoldsTheImage) {
  CameraParameters parameters;
  parameters.focal_px = 500.0;
  parameters.k1 = -0.3;
  EXPECT_THROW(CameraModel{parameters}, std::invalid_argument);
  parameters.k1 = 0.0;
  parameters.height_m = 0.0;
  EXPECT_THROW(CameraModel{parameters}, std::invalid_argument);
}

TEST(LocalPlaneMap, StaysWithinAThousandthOfAPixel) {
  const CameraModel camera(wide_tilted_camera());
  RandomStream random(7);
  double worst_px = 0.0;
  for (int i = 0; i < 50; ++i) {
    const PixelPoint low(random.uniform(0, 1200), random.uniform(0, 880));
    const LocalPlaneMap map(camera, 0.15, low, low + PixelPoint(64, 64));
    for (int j = 0; j < 50; ++j) {
      const PixelPoint pixel = low + PixelPoint(random.uniform(0, 64), random.uniform(0, 64));
      const double t = map.t(pixel.x());
      Eigen::Matrix<double, 5, 1> powers;
      powers << 1.0, t, t * t, t * t * t, t * t * t * t;
      const Eigen::Vector2d place = map.row(pixel.y()) * powers;
      worst_px = std::max(worst_px, (camera.project({place.x(), place.y(), 0.15}) - pixel).norm());
    }
  }
  EXPECT_LT(worst_px, 1e-3);
}

TEST(RobotPath, CircleHasItsSpeedAndFacesItsTravel) {
  RobotPath path;
  path.kind = RobotPath::Kind::kCircle;
  path.centre_m = {1.0, 2.0};
  path.radius_m = 0.5;
  path.speed_mps = 0.8;
  path.faces_travel = true;
  const RobotMotion motion = path.at(0.3);
  const double angle = 0.8 * 0.3 / 0.5;
  EXPECT_NEAR(motion.x_m, 1.0 + 0.5 * std::cos(angle), 1e-12);
  EXPECT_NEAR(motion.y_m, 2.0 + 0.5 * std::sin(angle), 1e-12);
  EXPECT_NEAR(motion.heading_rad, angle + std::numbers::pi / 2.0, 1e-12);
  EXPECT_NEAR(std::hypot(motion.velocity_x_mps, motion.velocity_y_mps), 0.8, 1e-6);
  EXPECT_NEAR(motion.heading_rate_radps, 1.6, 1e-9);
  path.speed_mps = -0.8;
  EXPECT_NEAR(path.at(0.0).heading_rad, -std::numbers::pi / 2.0, 1e-12);
}

TEST(RobotPath, OpenPathGoesToAndFroAndClosedPathRound) {
  RobotPath path;
  path.kind = RobotPath::Kind::kPolyline;
  path.corners_m = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}};
  path.speed_mps = 1.0;
  EXPECT_NEAR(path.at(1.5).y_m, 0.5, 1e-12);
  EXPECT_NEAR(path.at(2.5).y_m, 0.5, 1e-12);
  EXPECT_NEAR(path.at(2.5).velocity_y_mps, -1.0, 1e-9);
  EXPECT_NEAR(path.at(4.25).x_m, 0.25, 1e-12);
  path.closed = true;
  const double home_s = 2.0 + std::sqrt(2.0);
  EXPECT_NEAR(path.at(home_s + 0.25).x_m, 0.25, 1e-12);
  EXPECT_NEAR(path.at(home_s + 0.25).y_m, 0.0, 1e-12);
}

}  // namespace
}  // namespace nadir::vision
