#include "vision/synthetic/floor_image.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "vision/synthetic/local_plane_map.h"
#include "vision/synthetic/random_stream.h"

namespace nadir::vision {
namespace {

constexpr std::uint64_t kTexturePurpose = 4;
constexpr int kTilePx = 64;

/// Smooth noise of unit RMS with features about `grain_px` wide.
cv::Mat smooth_noise(cv::Size size, double grain_px, RandomStream& random) {
  // Broad features are drawn on a coarser grid.
  const double reduction = std::max(1.0, grain_px / 2.0);
  const cv::Size coarse(std::max(4, static_cast<int>(std::ceil(size.width / reduction))),
                        std::max(4, static_cast<int>(std::ceil(size.height / reduction))));
  cv::Mat noise(coarse, CV_32F);
  for (int v = 0; v < coarse.height; ++v) {
    for (int u = 0; u < coarse.width; ++u) {
      noise.at<float>(v, u) = static_cast<float>(random.normal());
    }
  }
  cv::GaussianBlur(noise, noise, {}, grain_px / reduction);
  cv::Mat full;
  cv::resize(noise, full, size, 0, 0, cv::INTER_CUBIC);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(full, mean, deviation);
  return (full - mean[0]) / std::max(deviation[0], 1e-9);
}

/// Relative brightness of the carpet: tufts, coarser weave and worn patches.
cv::Mat carpet_brightness(cv::Size size, double texture, std::uint64_t seed) {
  RandomStream random(seed, 0, kTexturePurpose);
  cv::Mat brightness = 0.8 * smooth_noise(size, 0.8, random);
  brightness += 0.5 * smooth_noise(size, 3.0, random);
  brightness += 0.33 * smooth_noise(size, 60.0, random);
  return 1.0 + texture * brightness;
}

double blurred_step(double distance_px, double sigma_px) {
  return 0.5 * std::erfc(-distance_px / (sigma_px * std::numbers::sqrt2));
}

/// Paints one line into one tile. Across and along the line its blurred box is known in closed
/// form.
void paint_line(const FloorLine& line, const CameraModel& camera, const LocalPlaneMap& map,
                const cv::Rect& tile, double sigma_px, const Reflectance& colour, cv::Mat& image) {
  const Eigen::Vector2d way = line.to_m - line.from_m;
  const double half_m = 0.5 * way.norm();
  const Eigen::Vector2d along = way / (2.0 * half_m);
  const Eigen::Vector2d middle_m = 0.5 * (line.from_m + line.to_m);
  const Eigen::Vector2d tile_middle_m =
      camera.on_plane({tile.x + 0.5 * (tile.width - 1), tile.y + 0.5 * (tile.height - 1)}, 0.0);
  const Eigen::Matrix2d scale =
      camera.pixels_per_metre({tile_middle_m.x(), tile_middle_m.y(), 0.0});
  const double per_m = std::sqrt(std::abs(scale.determinant()));
  for (int v = tile.y; v < tile.y + tile.height; ++v) {
    const LocalPlaneMap::RowPolynomial row = map.row(v);
    for (int u = tile.x; u < tile.x + tile.width; ++u) {
      const double t = map.t(u);
      Eigen::Matrix<double, 5, 1> powers;
      powers << 1.0, t, t * t, t * t * t, t * t * t * t;
      const Eigen::Vector2d offset_m = row * powers - middle_m;
      const double along_px = std::abs(offset_m.dot(along)) * per_m;
      const double across_px =
          std::abs(along.x() * offset_m.y() - along.y() * offset_m.x()) * per_m;
      const double half_width_px = 0.5 * line.width_m * per_m;
      if (across_px > half_width_px + 5.0 * sigma_px) continue;
      const double share = (blurred_step(across_px + half_width_px, sigma_px) -
                            blurred_step(across_px - half_width_px, sigma_px)) *
                           blurred_step(half_m * per_m - along_px, sigma_px);
      auto& pixel = image.at<cv::Vec3f>(v, u);
      pixel += static_cast<float>(share) * (colour - pixel);
    }
  }
}

}  // namespace

cv::Mat floor_image(const Scene& scene, const CameraModel& camera, std::uint64_t seed) {
  const cv::Size size(camera.width_px(), camera.height_px());
  cv::Mat image(size, CV_32FC3,
                cv::Scalar(scene.floor.colour[0], scene.floor.colour[1], scene.floor.colour[2]));
  if (scene.floor.texture > 0.0) {
    cv::Mat brightness = carpet_brightness(size, scene.floor.texture, seed);
    if (scene.point_spread_px > 0.0) {
      cv::GaussianBlur(brightness, brightness, {}, scene.point_spread_px);
    }
    const cv::Mat channels[3] = {brightness, brightness, brightness};
    cv::Mat coloured;
    cv::merge(channels, 3, coloured);
    image = image.mul(coloured);
  }
  // A pixel's own square adds a variance of 1/12.
  const double sigma_px = std::hypot(scene.point_spread_px, std::sqrt(1.0 / 12.0));
  for (int v = 0; v < size.height && !scene.floor.lines.empty(); v += kTilePx) {
    for (int u = 0; u < size.width; u += kTilePx) {
      const cv::Rect tile = cv::Rect(u, v, kTilePx, kTilePx) & cv::Rect({0, 0}, size);
      const LocalPlaneMap map(camera, 0.0, {u, v}, {u + kTilePx, v + kTilePx});
      if (!map.valid()) continue;
      for (const FloorLine& line : scene.floor.lines) {
        paint_line(line, camera, map, tile, sigma_px, scene.floor.line_colour, image);
      }
    }
  }
  return image;
}

}  // namespace nadir::vision
