#include "tests/bench/cramer_rao.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

namespace nadir::bench {
namespace {

constexpr double kAroundDisc_px = 4.0;  // what lies farther off says nothing of its edge
constexpr double kStep_m = 5e-5;
constexpr double kStep_rad = 1e-3;
constexpr double kRounding = 1.0 / 12.0;
constexpr double kPlateBeyond_m = 0.05;

vision::RobotMotion shifted(vision::RobotMotion motion, int axis, double step) {
  (axis == 0 ? motion.x_m : axis == 1 ? motion.y_m : motion.heading_rad) += step;
  return motion;
}

}  // namespace

CramerRaoBound::CramerRaoBound(const vision::Scene& scene)
    : scene_(scene),
      camera_(scene.camera),
      light_(scene.light, camera_.width_px(), camera_.height_px()),
      painter_(camera_, scene.point_spread_px, scene.sensor.exposure_s, 8),
      sensor_(scene.sensor) {}

vision::Sprite CramerRaoBound::sprite_of(const vision::RobotPlacement& robot) const {
  const vision::MarkerLayout& layout = scene_.layouts.at(robot.layout);
  const auto colours = vision::printed_reflectances();
  int identity = 0;
  for (std::size_t i = 0; i < layout.identities.size(); ++i) {
    if (layout.identities[i].id == robot.id) identity = static_cast<int>(i);
  }
  vision::Sprite sprite;
  sprite.height_m = layout.height_m;
  sprite.motion = robot.motion;
  for (int i = 0; i < layout.disc_count(); ++i) {
    const vision::Disc disc = layout.disc(i, static_cast<int>(robot.team), identity);
    sprite.discs.push_back({.position_m = disc.position_robot_m,
                            .radius_m = disc.radius_m,
                            .colour = colours[static_cast<std::size_t>(disc.colour)]});
  }
  vision::RobotBody body = scene_.bodies.at(robot.layout);
  body.radius_m = sprite.extent_m() + kPlateBeyond_m;
  body.front_m = body.radius_m;
  sprite.body = body;
  return sprite;
}

Eigen::MatrixXd CramerRaoBound::light_of(const vision::Sprite& sprite,
                                         const vision::ShadowEdge* shadow, const cv::Rect& region) {
  painter_.paint(sprite, shadow, patch_);
  Eigen::MatrixXd light = Eigen::MatrixXd::Zero(region.area(), 3);
  for (int v = region.y; v < region.br().y; ++v) {
    for (int u = region.x; u < region.br().x; ++u) {
      if (!patch_.region_px.contains({u, v})) continue;
      const cv::Vec4f paint =
          patch_.premultiplied.at<cv::Vec4f>(v - patch_.region_px.y, u - patch_.region_px.x);
      const cv::Vec3f white = light_.grey_levels(u, v);
      for (int c = 0; c < 3; ++c) {
        light((v - region.y) * region.width + u - region.x, c) =
            static_cast<double>(white[c]) * static_cast<double>(paint[c]);
      }
    }
  }
  return light;
}

Eigen::Matrix3d CramerRaoBound::covariance(const vision::RobotPlacement& robot,
                                           const vision::ShadowEdge* shadow) {
  vision::Sprite sprite = sprite_of(robot);
  painter_.paint(sprite, shadow, patch_);
  const cv::Rect region = patch_.region_px;
  const Eigen::MatrixXd light = light_of(sprite, shadow, region);

  std::array<Eigen::MatrixXd, 3> by_pose;
  for (int axis = 0; axis < 3; ++axis) {
    const double step = axis == 2 ? kStep_rad : kStep_m;
    vision::Sprite moved = sprite;
    moved.motion = shifted(robot.motion, axis, step);
    const Eigen::MatrixXd after = light_of(moved, shadow, region);
    moved.motion = shifted(robot.motion, axis, -step);
    by_pose[static_cast<std::size_t>(axis)] =
        (after - light_of(moved, shadow, region)) / (2.0 * step);
  }
  // Each disc alone, white on black: the derivative by its contrast.
  const std::size_t count = sprite.discs.size();
  std::vector<Eigen::MatrixXd> of_disc;
  for (std::size_t i = 0; i < count; ++i) {
    vision::Sprite alone = sprite;
    alone.body->colour = {0, 0, 0};
    alone.discs = {sprite.discs[i]};
    alone.discs[0].colour = {1, 1, 1};
    of_disc.push_back(light_of(alone, shadow, region));
  }
  const double c = std::cos(robot.motion.heading_rad);
  const double s = std::sin(robot.motion.heading_rad);
  const Eigen::Matrix2d scale =
      camera_.pixels_per_metre({robot.motion.x_m, robot.motion.y_m, sprite.height_m});
  const double px_per_m = std::sqrt(std::abs(scale.determinant()));
  const double shot = 255.0 / scene_.sensor.full_well_electrons;
  const double read = std::pow(scene_.sensor.read_noise_electrons * shot, 2) + kRounding;

  const auto unknowns = static_cast<Eigen::Index>(3 + 6 * count);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(unknowns, unknowns);
  Eigen::VectorXd row(unknowns);
  for (int v = region.y; v < region.br().y; ++v) {
    for (int u = region.x; u < region.br().x; ++u) {
      const Eigen::Vector2d place_m = camera_.on_plane({u, v}, sprite.height_m);
      std::size_t nearest = 0;
      double nearest_m = INFINITY;
      for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector2d& p = sprite.discs[i].position_m;
        const Eigen::Vector2d centre(robot.motion.x_m + c * p.x() - s * p.y(),
                                     robot.motion.y_m + s * p.x() + c * p.y());
        const double outside_m = (place_m - centre).norm() - sprite.discs[i].radius_m;
        if (outside_m < nearest_m) {
          nearest = i;
          nearest_m = outside_m;
        }
      }
      if (nearest_m * px_per_m > kAroundDisc_px) continue;
      const Eigen::Index pixel = (v - region.y) * region.width + u - region.x;
      for (int channel = 0; channel < 3; ++channel) {
        if (sensor_.has_mosaic() && sensor_.native_channel(u, v) != channel) continue;
        row.setZero();
        for (int axis = 0; axis < 3; ++axis) {
          row[axis] = by_pose[static_cast<std::size_t>(axis)](pixel, channel);
        }
        row[static_cast<Eigen::Index>(3 + 6 * nearest) + channel] = 1.0;
        for (std::size_t i = 0; i < count; ++i) {
          row[static_cast<Eigen::Index>(6 + 6 * i) + channel] = of_disc[i](pixel, channel);
        }
        information += row * row.transpose() / (shot * light(pixel, channel) + read);
      }
    }
  }
  return information.inverse().topLeftCorner<3, 3>();
}

}  // namespace nadir::bench
