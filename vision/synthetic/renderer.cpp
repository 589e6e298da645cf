#include "vision/synthetic/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "vision/synthetic/floor_image.h"

namespace nadir::vision {
namespace {

constexpr std::uint64_t kNoisePurpose = 5;
constexpr std::int64_t kEpochNs = 1'700'000'000'000'000'000;

Sprite clutter_sprite(const ClutterDisc& clutter) {
  const auto colour = static_cast<std::size_t>(clutter.colour);
  Sprite sprite;
  sprite.height_m = clutter.height_m;
  sprite.motion.x_m = clutter.place_m.x();
  sprite.motion.y_m = clutter.place_m.y();
  sprite.discs.push_back({.radius_m = clutter.radius_m,
                          .colour = printed_reflectances()[colour],
                          .shading = clutter.shading});
  return sprite;
}

Scene checked(Scene scene) {
  if (scene.bodies.size() != scene.layouts.size()) {
    throw std::invalid_argument("a scene needs one robot body for each layout");
  }
  for (const SceneRobot& robot : scene.robots) {
    if (robot.team >= scene.layouts.at(robot.layout).teams.size()) {
      throw std::invalid_argument("a robot's team is not in its layout");
    }
  }
  if (!(scene.rate_hz > 0.0)) throw std::invalid_argument("the frame rate must be positive");
  return scene;
}

std::size_t identity_index(const MarkerLayout& layout, int id) {
  if (!layout.has_robot(id)) {
    throw std::invalid_argument("layout " + layout.name + " has no robot " + std::to_string(id));
  }
  const auto found = std::ranges::find(layout.identities, id, &Identity::id);
  return found == layout.identities.end() ? 0 : found - layout.identities.begin();
}

void add_tags(const TagLayout& layout, int robot_id, Sprite& sprite) {
  const auto paint = [](Colour colour) {
    const Reflectance printed = printed_reflectances()[static_cast<std::size_t>(colour)];
    return Eigen::Array4f(printed[0], printed[1], printed[2], 1.0F);
  };
  for (const MountedTag& tag : layout.tags_of(robot_id)) {
    sprite.tags.push_back({.mount = tag.mount,
                           .cell_m = layout.size_m / layout.facts().square_cells,
                           .pattern = tag_pattern(layout.family, tag.tag_id),
                           .white = paint(Colour::kWhite),
                           .black = paint(Colour::kBlack)});
  }
}

}  // namespace

Renderer::Renderer(Scene scene, std::uint64_t seed)
    : scene_(checked(std::move(scene))),
      seed_(seed),
      camera_(scene_.camera),
      light_(scene_.light, camera_.width_px(), camera_.height_px()),
      painter_(camera_, scene_.point_spread_px, scene_.sensor.exposure_s, scene_.samples_per_px),
      sensor_(scene_.sensor) {
  for (const RobotPlacement& robot : placements(0)) robot_sprite(robot);  // throws on what is wrong
  make_background();
}

void Renderer::make_background() {
  background_ = floor_image(scene_, camera_, seed_);
  for (int v = 0; v < background_.rows; ++v) {
    auto* row = background_.ptr<cv::Vec3f>(v);
    for (int u = 0; u < background_.cols; ++u) row[u] = row[u].mul(light_.grey_levels(u, v));
  }
  SpritePatch patch;
  for (const ClutterDisc& disc : scene_.clutter.discs) {
    painter_.paint(clutter_sprite(disc), nullptr, patch);
    for (int v = patch.region_px.y; v < patch.region_px.br().y; ++v) {
      blend(patch, v, background_.ptr<float>(v));
    }
  }
}

/// Lays one row of a patch over an image row: behind it shines what the sprite does not cover.
void Renderer::blend(const SpritePatch& patch, int v, float* row) const {
  const auto* painted = patch.premultiplied.ptr<cv::Vec4f>(v - patch.region_px.y);
  for (int i = 0; i < patch.region_px.width; ++i) {
    const cv::Vec4f& paint = painted[i];
    if (paint[3] <= 0.0F) continue;
    const int u = patch.region_px.x + i;
    const cv::Vec3f light = light_.grey_levels(u, v);
    float* pixel = row + 3 * static_cast<std::ptrdiff_t>(u);
    for (int c = 0; c < 3; ++c) pixel[c] = pixel[c] * (1.0F - paint[3]) + light[c] * paint[c];
  }
}

Sprite Renderer::robot_sprite(const RobotPlacement& robot) const {
  const MarkerLayout& layout = scene_.layouts.at(robot.layout);
  const auto colours = printed_reflectances();
  Sprite sprite;
  sprite.height_m = layout.height_m;
  sprite.motion = robot.motion;
  const RobotBody& body = scene_.bodies.at(robot.layout);
  if (body.radius_m > 0.0) sprite.body = body;
  if (layout.tags) add_tags(*layout.tags, robot.id, sprite);
  const auto identity = static_cast<int>(identity_index(layout, robot.id));
  for (int i = 0; i < layout.disc_count(); ++i) {
    const Disc disc = layout.disc(i, static_cast<int>(robot.team), identity);
    sprite.discs.push_back({.position_m = disc.position_robot_m,
                            .radius_m = disc.radius_m,
                            .colour = colours[static_cast<std::size_t>(disc.colour)]});
  }
  return sprite;
}

void Renderer::paint_sprites(std::uint64_t frame_number, std::span<const RobotPlacement> robots,
                             const ShadowEdge* shadow) {
  const std::vector<ClutterDisc> clutter = random_clutter_in_frame(
      scene_, camera_, seed_, frame_number, std::vector(robots.begin(), robots.end()));
  patch_count_ = clutter.size() + robots.size();
  if (patches_.size() < patch_count_) patches_.resize(patch_count_);
  std::size_t next = 0;
  for (const ClutterDisc& disc : clutter) {
    painter_.paint(clutter_sprite(disc), shadow, patches_[next++]);
  }
  for (const RobotPlacement& robot : robots) {
    painter_.paint(robot_sprite(robot), shadow, patches_[next++]);
  }
}

void Renderer::render(std::uint64_t frame_number, cv::Mat& bgr) {
  render_robots(frame_number, placements(frame_number), bgr);
}

void Renderer::render_robots(std::uint64_t frame_number, std::span<const RobotPlacement> robots,
                             cv::Mat& bgr) {
  const int width = camera_.width_px();
  const int height = camera_.height_px();
  std::optional<ShadowEdge> sharp;
  std::optional<ShadowEdge> blurred;
  if (scene_.light.shadow) {
    const SceneShadow shadow =
        shadow_in_frame(*scene_.light.shadow, width, height, seed_, frame_number);
    sharp.emplace(shadow, 0.0);
    blurred.emplace(shadow, std::hypot(scene_.point_spread_px, std::sqrt(1.0 / 12.0)));
  }
  paint_sprites(frame_number, robots, sharp ? &*sharp : nullptr);

  bgr.create(height, width, CV_8UC3);
  if (sensor_.has_mosaic()) mosaic_.create(height, width, CV_8UC1);
  RandomStream random(seed_, frame_number, kNoisePurpose);
  row_.resize(3 * static_cast<std::size_t>(width));
  shadow_row_.resize(width);
  for (int v = 0; v < height; ++v) {
    std::copy_n(background_.ptr<float>(v), row_.size(), row_.begin());
    if (blurred) {
      blurred->factors(0.0, 1.0, v, width, shadow_row_.data());
      for (int u = 0; u < width; ++u) {
        for (int c = 0; c < 3; ++c) row_[3 * u + c] *= shadow_row_[u];
      }
    }
    for (std::size_t i = 0; i < patch_count_; ++i) {
      const cv::Rect& region = patches_[i].region_px;
      if (v >= region.y && v < region.y + region.height) blend(patches_[i], v, row_.data());
    }
    sensor_.expose_row(row_.data(), width, v, random,
                       sensor_.has_mosaic() ? mosaic_.ptr(v) : bgr.ptr(v));
  }
  if (sensor_.has_mosaic()) sensor_.demosaic(mosaic_, bgr);
}

std::vector<RobotPlacement> Renderer::placements(std::uint64_t frame_number) const {
  return placements_in_frame(scene_, camera_, seed_, frame_number);
}

std::vector<RobotTruth> Renderer::truth(std::uint64_t frame_number) const {
  return truth_of(placements(frame_number));
}

std::vector<RobotTruth> Renderer::truth_of(std::span<const RobotPlacement> robots) const {
  return nadir::vision::truth_of(scene_, camera_, {robots.begin(), robots.end()});
}

CaptureTime Renderer::capture_time(std::uint64_t frame_number) const {
  const auto since_start_ns = static_cast<std::int64_t>(
      std::llround(static_cast<double>(frame_number) * 1e9 / scene_.rate_hz));
  return CaptureTime(std::chrono::nanoseconds(kEpochNs + since_start_ns));
}

}  // namespace nadir::vision
