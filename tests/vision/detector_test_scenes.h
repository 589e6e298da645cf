#pragma once

#include <Eigen/LU>
#include <opencv2/core.hpp>

#include "tests/vision/synthetic_test_scenes.h"
#include "vision/local_scale.h"
#include "vision/pixel_scale_grid.h"
#include "vision/synthetic/renderer.h"

namespace nadir::vision {

/// An even scene without noise and texture: the camera looks straight down from 3 m and shows
/// `scale_px_per_m` pixels per metre in the layout's marker plane; the image's middle is the
/// world's origin, u is x and v is -y.
inline Scene straight_scene(const MarkerLayout& layout, int width_px, int height_px,
                            double scale_px_per_m) {
  Scene scene = plain_scene(layout);
  scene.camera.width_px = width_px;
  scene.camera.height_px = height_px;
  scene.camera.centre_u_px = 0.5 * (width_px - 1);
  scene.camera.centre_v_px = 0.5 * (height_px - 1);
  scene.camera.focal_px = scale_px_per_m * (scene.camera.height_m - layout.height_m);
  return scene;
}

/// A robot of the scene's first layout whose origin is seen at a pixel.
inline RobotPlacement robot_at(const CameraModel& camera, const MarkerLayout& layout,
                               const PixelPoint& pixel, double heading_rad = 0.0,
                               std::size_t team = 0, int id = 0) {
  const Eigen::Vector2d place_m = camera.on_plane(pixel, layout.height_m);
  RobotPlacement robot;
  robot.team = team;
  robot.id = id;
  robot.motion.x_m = place_m.x();
  robot.motion.y_m = place_m.y();
  robot.motion.heading_rad = heading_rad;
  return robot;
}

/// The marker plane's exact scale, as a perfect calibration would give it.
inline PixelScaleGrid scale_of(const CameraModel& camera, double plane_height_m) {
  return {camera.width_px(), camera.height_px(), [&](const PixelPoint& pixel) {
            const Eigen::Vector2d at_m = camera.on_plane(pixel, plane_height_m);
            return Eigen::Matrix2d(
                camera.pixels_per_metre({at_m.x(), at_m.y(), plane_height_m}).inverse());
          }};
}

/// Square pixels, y against v as for every camera that looks down.
inline LocalScale square_scale(double scale_px_per_m) {
  LocalScale scale;
  scale.scale_px_per_m = static_cast<float>(scale_px_per_m);
  scale.pixels_per_metre << scale.scale_px_per_m, 0.0F, 0.0F, -scale.scale_px_per_m;
  scale.metres_per_pixel = scale.pixels_per_metre.inverse();
  return scale;
}

/// One grey level or colour everywhere.
inline cv::Mat flat_picture(int width_px, int height_px, const cv::Vec3b& bgr) {
  return {height_px, width_px, CV_8UC3, cv::Scalar(bgr[0], bgr[1], bgr[2])};
}

/// Fills the pixels within `radius_px` of a place.
inline void fill_disc(cv::Mat& bgr, const PixelPoint& centre, double radius_px,
                      const cv::Vec3b& colour) {
  for (int v = 0; v < bgr.rows; ++v) {
    for (int u = 0; u < bgr.cols; ++u) {
      if ((PixelPoint(u, v) - centre).norm() < radius_px) bgr.at<cv::Vec3b>(v, u) = colour;
    }
  }
}

}  // namespace nadir::vision
