#include "vision/synthetic/sprite.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace nadir::vision {
namespace {

constexpr double kKernelSigmas = 4.0;
constexpr int kMostInstants = 32;
constexpr double kTravelPerInstantPx = 0.25;
constexpr int kSmallRegionPx = 28;
constexpr double kSharpOpticsPx = 0.35;

double normal_share(double sigmas) { return 0.5 * std::erfc(-sigmas / std::numbers::sqrt2); }

/// Weight of a fine sample `offset_px` from a pixel's centre: the point spread integrated over the
/// pixel.
double pixel_weight(double offset_px, double point_spread_px) {
  if (point_spread_px <= 0.0) return std::abs(offset_px) < 0.5 ? 1.0 : 0.0;
  return normal_share((offset_px + 0.5) / point_spread_px) -
         normal_share((offset_px - 0.5) / point_spread_px);
}

}  // namespace

double Sprite::extent_m() const {
  double extent = body ? body->radius_m : 0.0;
  for (const Disc& disc : discs) {
    extent = std::max(extent, disc.position_m.norm() + disc.radius_m);
  }
  for (const PaintedTag& tag : tags) {
    extent = std::max(extent, tag.mount.position_robot_m.norm() + tag.extent_m());
  }
  return extent;
}

SpritePainter::SpritePainter(const CameraModel& camera, double point_spread_px, double exposure_s,
                             int samples_per_px)
    : camera_(camera),
      point_spread_px_(point_spread_px),
      exposure_s_(exposure_s),
      margin_px_(static_cast<int>(std::ceil(kKernelSigmas * point_spread_px))),
      samples_per_px_(samples_per_px) {}

void SpritePainter::set_fineness(int fineness) {
  if (fineness == fineness_) return;
  fineness_ = fineness;
  taps_.resize((2 * static_cast<std::size_t>(margin_px_) + 1) * fineness);
  double sum = 0.0;
  for (std::size_t i = 0; i < taps_.size(); ++i) {
    const double offset_px = (static_cast<double>(i) + 0.5) / fineness - 0.5 - margin_px_;
    taps_[i] = static_cast<float>(pixel_weight(offset_px, point_spread_px_));
    sum += taps_[i];
  }
  for (float& tap : taps_) tap = static_cast<float>(tap / sum);
}

cv::Rect SpritePainter::region_of(const Sprite& sprite) const {
  const cv::Rect nothing(0, 0, 0, 0);
  const double extent_m = sprite.extent_m();
  double low_u = INFINITY;
  double low_v = INFINITY;
  double high_u = -INFINITY;
  double high_v = -INFINITY;
  for (const double moment : {-0.5, 0.5}) {
    const double x_m = sprite.motion.x_m + moment * exposure_s_ * sprite.motion.velocity_x_mps;
    const double y_m = sprite.motion.y_m + moment * exposure_s_ * sprite.motion.velocity_y_mps;
    const PixelPoint centre = camera_.project({x_m, y_m, sprite.height_m});
    if (!centre.allFinite()) return nothing;
    const Eigen::Matrix2d scale = camera_.pixels_per_metre({x_m, y_m, sprite.height_m});
    // The scale changes over the sprite: 5 % and a pixel more than the linear size.
    const double reach_u = 1.05 * scale.row(0).norm() * extent_m + margin_px_ + 1.0;
    const double reach_v = 1.05 * scale.row(1).norm() * extent_m + margin_px_ + 1.0;
    low_u = std::min(low_u, centre.x() - reach_u);
    high_u = std::max(high_u, centre.x() + reach_u);
    low_v = std::min(low_v, centre.y() - reach_v);
    high_v = std::max(high_v, centre.y() + reach_v);
  }
  if (high_u < 0 || high_v < 0 || low_u > camera_.width_px() || low_v > camera_.height_px()) {
    return nothing;
  }
  const cv::Point low(static_cast<int>(std::floor(low_u)), static_cast<int>(std::floor(low_v)));
  const cv::Point high(static_cast<int>(std::ceil(high_u)), static_cast<int>(std::ceil(high_v)));
  return cv::Rect(low, high) & cv::Rect(0, 0, camera_.width_px(), camera_.height_px());
}

int SpritePainter::instants_of(const Sprite& sprite) const {
  const RobotMotion& motion = sprite.motion;
  const Eigen::Matrix2d scale = camera_.pixels_per_metre({motion.x_m, motion.y_m, sprite.height_m});
  const double speed_mps = std::hypot(motion.velocity_x_mps, motion.velocity_y_mps) +
                           std::abs(motion.heading_rate_radps) * sprite.extent_m();
  const double travel_px = scale.norm() * speed_mps * exposure_s_;
  return std::clamp(static_cast<int>(std::ceil(travel_px / kTravelPerInstantPx)), 1, kMostInstants);
}

void SpritePainter::prepare_instants(const Sprite& sprite, const cv::Rect& region) {
  fine_columns_ = (region.width + 2 * margin_px_) * fineness_;
  fine_rows_ = (region.height + 2 * margin_px_) * fineness_;
  fine_origin_u_px_ = region.x - margin_px_ - 0.5 + 0.5 / fineness_;
  fine_origin_v_px_ = region.y - margin_px_ - 0.5 + 0.5 / fineness_;
  const int count = instants_of(sprite);
  instants_.resize(count);
  for (int i = 0; i < count; ++i) {
    Instant& instant = instants_[i];
    const double time_s = exposure_s_ * ((i + 0.5) / count - 0.5);
    const RobotMotion& motion = sprite.motion;
    instant.place_m = {motion.x_m + time_s * motion.velocity_x_mps,
                       motion.y_m + time_s * motion.velocity_y_mps};
    const double heading_rad = motion.heading_rad + time_s * motion.heading_rate_radps;
    instant.cosine = std::cos(heading_rad);
    instant.sine = std::sin(heading_rad);
    Eigen::Matrix2d world_from_sprite;
    world_from_sprite << instant.cosine, -instant.sine, instant.sine, instant.cosine;
    const Eigen::Matrix2d scale =
        camera_.pixels_per_metre({instant.place_m.x(), instant.place_m.y(), sprite.height_m});
    instant.fine_per_metre =
        static_cast<float>(fineness_ * std::sqrt(std::abs(scale.determinant())));
    instant.layers.clear();
    const auto add = [&](const Eigen::Vector2d& position_m, double radius_m,
                         const Sprite::Disc* disc, const PaintedTag* tag) {
      const Eigen::Vector2d place_m = instant.place_m + world_from_sprite * position_m;
      const PixelPoint pixel = camera_.project({place_m.x(), place_m.y(), sprite.height_m});
      instant.layers.push_back({disc, tag, (pixel.x() - fine_origin_u_px_) * fineness_,
                                (pixel.y() - fine_origin_v_px_) * fineness_,
                                1.1 * scale.norm() * radius_m * fineness_ + 2.0});
    };
    if (sprite.body) add(Eigen::Vector2d::Zero(), sprite.body->radius_m, nullptr, nullptr);
    for (const Sprite::Disc& disc : sprite.discs) {
      add(disc.position_m, disc.radius_m, &disc, nullptr);
    }
    for (const PaintedTag& tag : sprite.tags) {
      add(tag.mount.position_robot_m, tag.extent_m(), nullptr, &tag);
    }
  }
}

void SpritePainter::paint(const Sprite& sprite, const ShadowEdge* shadow, SpritePatch& patch) {
  patch.region_px = region_of(sprite);
  if (patch.region_px.empty()) return;
  const cv::Rect& region = patch.region_px;
  const bool fine = point_spread_px_ < kSharpOpticsPx ||
                    std::max(region.width, region.height) - 2 * margin_px_ <= kSmallRegionPx;
  const int automatic = fine ? 8 : 4;
  set_fineness(samples_per_px_ > 0 ? samples_per_px_ : automatic);
  prepare_instants(sprite, region);
  const PixelPoint low(fine_origin_u_px_, fine_origin_v_px_);
  const PixelPoint high = low + PixelPoint(fine_columns_ - 1, fine_rows_ - 1) / fineness_;
  const LocalPlaneMap map(camera_, sprite.height_m, low, high);
  if (!map.valid()) {
    patch.region_px = {};
    return;
  }
  fine_.resize(static_cast<std::size_t>(fine_columns_) * fine_rows_);
  local_x_.resize(fine_columns_);
  local_y_.resize(fine_columns_);
  coverage_.resize(fine_columns_);
  shares_.resize(fine_columns_);
  row_.resize(fine_columns_);
  const double middle_px = shadow != nullptr ? shadow->distance_px(region.x + 0.5 * region.width,
                                                                   region.y + 0.5 * region.height)
                                             : INFINITY;
  const bool shaded =
      shadow != nullptr &&
      middle_px < shadow->reach_px() + std::hypot(region.width, region.height) + 2 * margin_px_;
  for (int row = 0; row < fine_rows_; ++row) {
    const double v_px = fine_origin_v_px_ + static_cast<double>(row) / fineness_;
    paint_fine_row(sprite, map, row, v_px);
    if (shaded) shade_fine_row(*shadow, row, fine_origin_u_px_, v_px);
  }
  blur_into(patch);
}

void SpritePainter::paint_fine_row(const Sprite& sprite, const LocalPlaneMap& map, int row,
                                   double v_px) {
  const LocalPlaneMap::RowPolynomial world = map.row(v_px);
  const auto first_t = static_cast<float>(map.t(fine_origin_u_px_));
  const auto step_t =
      static_cast<float>(map.t(fine_origin_u_px_ + 1.0 / fineness_) - map.t(fine_origin_u_px_));
  Eigen::Array4f* out = &fine_[static_cast<std::size_t>(row) * fine_columns_];
  std::fill(out, out + fine_columns_, Eigen::Array4f::Zero());
  const auto weight = 1.0F / static_cast<float>(instants_.size());
  for (const Instant& instant : instants_) {
    LocalPlaneMap::RowPolynomial moved = world;
    moved.col(0) -= instant.place_m;
    Eigen::Matrix2d sprite_from_world;
    sprite_from_world << instant.cosine, instant.sine, -instant.sine, instant.cosine;
    const Eigen::Matrix<float, 2, 5> c = (sprite_from_world * moved).cast<float>();
    for (int i = 0; i < fine_columns_; ++i) {
      const float t = first_t + static_cast<float>(i) * step_t;
      local_x_[i] = c(0, 0) + t * (c(0, 1) + t * (c(0, 2) + t * (c(0, 3) + t * c(0, 4))));
      local_y_[i] = c(1, 0) + t * (c(1, 1) + t * (c(1, 2) + t * (c(1, 3) + t * c(1, 4))));
    }
    std::fill(row_.begin(), row_.end(), Eigen::Array4f::Zero());
    for (const Layer& layer : instant.layers) paint_layer(sprite, instant, layer, row);
    for (int i = 0; i < fine_columns_; ++i) out[i] += weight * row_[i];
  }
}

/// Shares of the samples [begin, end) in a disc or the body.
void SpritePainter::cover_shape(const Sprite& sprite, const Instant& instant, const Layer& layer,
                                int begin, int end) {
  const Sprite::Disc* disc = layer.disc;
  const Eigen::Vector2f centre =
      disc != nullptr ? disc->position_m.cast<float>().eval() : Eigen::Vector2f::Zero().eval();
  const auto radius = static_cast<float>(disc != nullptr ? disc->radius_m : sprite.body->radius_m);
  // A disc has no flat front: put it where it never cuts.
  const auto front = static_cast<float>(disc != nullptr ? 1e3 : sprite.body->front_m);
  const float scale = instant.fine_per_metre;
  for (int i = begin; i < end; ++i) {
    const float dx = local_x_[i] - centre.x();
    const float dy = local_y_[i] - centre.y();
    const float beyond_rim = std::sqrt(dx * dx + dy * dy) - radius;
    const float beyond_front = dx - front;
    const float outside = beyond_rim > beyond_front ? beyond_rim : beyond_front;
    const float share = 0.5F - outside * scale;
    coverage_[i] = share < 0.0F ? 0.0F : (share > 1.0F ? 1.0F : share);
  }
}

void SpritePainter::paint_layer(const Sprite& sprite, const Instant& instant, const Layer& layer,
                                int row) {
  const double dv = row - layer.row;
  if (std::abs(dv) > layer.reach) return;
  const double half = std::sqrt(layer.reach * layer.reach - dv * dv) + 2.0;
  const int begin = std::clamp(static_cast<int>(layer.column - half), 0, fine_columns_);
  const int end = std::clamp(static_cast<int>(layer.column + half) + 1, begin, fine_columns_);
  if (layer.tag != nullptr) {
    paint_tag(*layer.tag, local_x_.data(), local_y_.data(), begin, end,
              1.0F / instant.fine_per_metre, row_.data());
    return;
  }
  cover_shape(sprite, instant, layer, begin, end);
  const Sprite::Disc* disc = layer.disc;
  const Reflectance& colour = disc != nullptr ? disc->colour : sprite.body->colour;
  const Eigen::Array4f paint(colour[0], colour[1], colour[2], 1.0F);
  if (disc == nullptr || disc->shading == 0.0) {
    for (int i = begin; i < end; ++i) row_[i] += coverage_[i] * (paint - row_[i]);
    return;
  }
  const Eigen::Vector2f centre = disc->position_m.cast<float>();
  const auto radius = static_cast<float>(disc->radius_m);
  const auto shading = static_cast<float>(disc->shading) / (radius * radius);
  for (int i = begin; i < end; ++i) {
    const float dx = local_x_[i] - centre.x();
    const float dy = local_y_[i] - centre.y();
    const float left = std::max(0.0F, 1.0F - shading * (dx * dx + dy * dy));
    row_[i] += coverage_[i] * (paint * Eigen::Array4f(left, left, left, 1.0F) - row_[i]);
  }
}

void SpritePainter::shade_fine_row(const ShadowEdge& shadow, int row, double first_u_px,
                                   double v_px) {
  shadow.factors(first_u_px, 1.0 / fineness_, v_px, fine_columns_, shares_.data());
  Eigen::Array4f* out = &fine_[static_cast<std::size_t>(row) * fine_columns_];
  for (int i = 0; i < fine_columns_; ++i) {
    out[i] *= Eigen::Array4f(shares_[i], shares_[i], shares_[i], 1.0F);
  }
}

void SpritePainter::blur_into(SpritePatch& patch) {
  const int width = patch.region_px.width;
  const int height = patch.region_px.height;
  const int taps = static_cast<int>(taps_.size());
  half_blurred_.resize(static_cast<std::size_t>(width) * fine_rows_);
  for (int row = 0; row < fine_rows_; ++row) {
    const Eigen::Array4f* in = &fine_[static_cast<std::size_t>(row) * fine_columns_];
    for (int u = 0; u < width; ++u) {
      Eigen::Array4f sum = Eigen::Array4f::Zero();
      for (int k = 0; k < taps; ++k) sum += taps_[k] * in[u * fineness_ + k];
      half_blurred_[static_cast<std::size_t>(row) * width + u] = sum;
    }
  }
  patch.premultiplied.create(height, width, CV_32FC4);
  for (int v = 0; v < height; ++v) {
    auto* out = patch.premultiplied.ptr<cv::Vec4f>(v);
    for (int u = 0; u < width; ++u) {
      Eigen::Array4f sum = Eigen::Array4f::Zero();
      for (int k = 0; k < taps; ++k) {
        sum += taps_[k] * half_blurred_[static_cast<std::size_t>(v * fineness_ + k) * width + u];
      }
      out[u] = cv::Vec4f(sum[0], sum[1], sum[2], sum[3]);
    }
  }
}

}  // namespace nadir::vision
