#include "tests/bench/tag_bound.h"

#include <Eigen/LU>
#include <cmath>

namespace nadir::bench {
namespace {

constexpr double kStep_m = 5e-5;
constexpr double kStep_rad = 1e-3;
constexpr double kRounding = 1.0 / 12.0;
constexpr double kRimSigmas = 2.0;

vision::Sprite sprite_of(const vision::Scene& scene, const vision::RobotPlacement& robot,
                         float white, float black) {
  const vision::TagLayout& layout = *scene.layouts.at(robot.layout).tags;
  vision::Sprite sprite;
  sprite.height_m = scene.layouts.at(robot.layout).height_m;
  sprite.motion = robot.motion;
  for (const vision::MountedTag& tag : layout.tags_of(robot.id)) {
    sprite.tags.push_back({.mount = tag.mount,
                           .cell_m = layout.size_m / layout.facts().square_cells,
                           .pattern = vision::tag_pattern(layout.family, tag.tag_id),
                           .white = {white, white, white, 1.0F},
                           .black = {black, black, black, 1.0F}});
  }
  return sprite;
}

// Light of a sprite in a region, grey levels where white reflects 1; one channel.
Eigen::MatrixXd light_of(vision::SpritePainter& painter, const vision::Sprite& sprite,
                         const cv::Rect& region) {
  vision::SpritePatch patch;
  painter.paint(sprite, nullptr, patch);
  Eigen::MatrixXd light = Eigen::MatrixXd::Zero(region.height, region.width);
  for (int v = 0; v < region.height; ++v) {
    for (int u = 0; u < region.width; ++u) {
      const cv::Point at(u + region.x, v + region.y);
      if (!patch.region_px.contains(at)) continue;
      light(v, u) =
          static_cast<double>(patch.premultiplied.at<cv::Vec4f>(at - patch.region_px.tl())[1]);
    }
  }
  return light;
}

}  // namespace

Eigen::Matrix3d tag_bound(const vision::Scene& scene, const vision::RobotPlacement& robot) {
  const vision::CameraModel camera(scene.camera);
  vision::SpritePainter painter(camera, scene.point_spread_px, 0.0, 8);
  const vision::LightField field(scene.light, camera.width_px(), camera.height_px());
  const vision::ImageSensor sensor(scene.sensor);
  const auto printed = vision::printed_reflectances();
  const float black = printed[static_cast<std::size_t>(vision::Colour::kBlack)][1];
  const vision::Sprite sprite = sprite_of(scene, robot, 1.0F, black);
  vision::SpritePatch patch;
  painter.paint(sprite, nullptr, patch);
  const cv::Rect region = patch.region_px;
  const Eigen::MatrixXd share = light_of(painter, sprite_of(scene, robot, 1.0F, 0.0F), region);
  const Eigen::MatrixXd light = light_of(painter, sprite, region);
  std::array<Eigen::MatrixXd, 3> by_pose;
  for (int axis = 0; axis < 3; ++axis) {
    const double step = axis == 2 ? kStep_rad : kStep_m;
    vision::Sprite moved = sprite;
    double& value = axis == 0   ? moved.motion.x_m
                    : axis == 1 ? moved.motion.y_m
                                : moved.motion.heading_rad;
    value += step;
    const Eigen::MatrixXd after = light_of(painter, moved, region);
    value -= 2.0 * step;
    by_pose[static_cast<std::size_t>(axis)] =
        (after - light_of(painter, moved, region)) / (2.0 * step);
  }
  const double shot = 255.0 / scene.sensor.full_well_electrons;
  const double read = std::pow(scene.sensor.read_noise_electrons * shot, 2) + kRounding;
  const double scale = std::sqrt(
      std::abs(camera.pixels_per_metre({robot.motion.x_m, robot.motion.y_m, sprite.height_m})
                   .determinant()));
  const vision::PaintedTag& tag = sprite.tags.front();
  const double reach_m = 0.5 * tag.cell_m * tag.pattern.cells -
                         kRimSigmas * std::hypot(scene.point_spread_px, 0.29) / scale;
  const double heading = robot.motion.heading_rad;
  const Eigen::Vector2d along(std::cos(heading), std::sin(heading));
  Eigen::Matrix<double, 9, 9> information = Eigen::Matrix<double, 9, 9>::Zero();
  for (int v = 0; v < region.height; ++v) {
    for (int u = 0; u < region.width; ++u) {
      const Eigen::Vector2d away = camera.on_plane({u + region.x, v + region.y}, sprite.height_m) -
                                   Eigen::Vector2d(robot.motion.x_m, robot.motion.y_m);
      const double across = along.x() * away.y() - along.y() * away.x();
      if (std::abs(along.dot(away)) > reach_m || std::abs(across) > reach_m) continue;
      const cv::Vec3f white = field.grey_levels(u + region.x, v + region.y);
      for (int channel = 0; channel < 3; ++channel) {
        if (sensor.has_mosaic() && sensor.native_channel(u + region.x, v + region.y) != channel) {
          continue;
        }
        const auto grey = static_cast<double>(white[channel]);
        Eigen::Matrix<double, 9, 1> row = Eigen::Matrix<double, 9, 1>::Zero();
        for (int axis = 0; axis < 3; ++axis) {
          row[axis] = grey * by_pose[static_cast<std::size_t>(axis)](v, u);
        }
        row[3 + 2 * channel] = 1.0;
        row[4 + 2 * channel] = grey * share(v, u);
        information += row * row.transpose() / (shot * grey * light(v, u) + read);
      }
    }
  }
  return information.inverse().topLeftCorner<3, 3>();
}

}  // namespace nadir::bench
