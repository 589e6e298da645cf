#include "vision/hue_probe.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vision/vector_clones.h"

namespace nadir::vision {

HueProbe::HueProbe(const std::vector<Eigen::Vector2f>& offsets_m, std::vector<ColourScore> colours)
    : colours_(std::move(colours)),
      place_(offsets_m.size()),
      outside_(offsets_m.size()),
      blue_(offsets_m.size()),
      green_(offsets_m.size()),
      red_(offsets_m.size()),
      hue_(offsets_m.size()) {
  for (const Eigen::Vector2f& offset_m : offsets_m) {
    x_m_.push_back(offset_m.x());
    y_m_.push_back(offset_m.y());
  }
}

NADIR_VECTOR_CLONES
const std::vector<float>& HueProbe::look(const cv::Mat& bgr, const LocalScale& scale,
                                         const PixelPoint& centre, const Bgr& surroundings) {
  const float ux = scale.pixels_per_metre(0, 0);
  const float uy = scale.pixels_per_metre(0, 1);
  const float vx = scale.pixels_per_metre(1, 0);
  const float vy = scale.pixels_per_metre(1, 1);
  const auto u0 = static_cast<float>(centre.x());
  const auto v0 = static_cast<float>(centre.y());
  const auto right = static_cast<float>(bgr.cols - 1);
  const auto bottom = static_cast<float>(bgr.rows - 1);
  const int row_bytes = static_cast<int>(bgr.step);
  const std::size_t count = hue_.size();
  const float* __restrict x_m = x_m_.data();
  const float* __restrict y_m = y_m_.data();
  int* __restrict place = place_.data();
  float* __restrict outside = outside_.data();
  for (std::size_t i = 0; i < count; ++i) {
    const float u = u0 + ux * x_m[i] + uy * y_m[i];
    const float v = v0 + vx * x_m[i] + vy * y_m[i];
    const float inside_u = std::min(std::max(u, 0.0F), right);
    const float inside_v = std::min(std::max(v, 0.0F), bottom);
    outside[i] = u == inside_u && v == inside_v ? 0.0F : kOutside;
    place[i] =
        static_cast<int>(inside_v + 0.5F) * row_bytes + 3 * static_cast<int>(inside_u + 0.5F);
  }
  float* __restrict blue = blue_.data();
  float* __restrict green = green_.data();
  float* __restrict red = red_.data();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* const pixel = bgr.data + place[i];
    blue[i] = pixel[0];
    green[i] = pixel[1];
    red[i] = pixel[2];
  }
  float* __restrict hue = hue_.data();
  for (std::size_t i = 0; i < count; ++i) hue[i] = kOutside;
  for (const ColourScore& colour : colours_) {
    const auto dot = [&](const Bgr& weight, std::size_t i) {
      return weight[0] * (blue[i] - surroundings[0]) + weight[1] * (green[i] - surroundings[1]) +
             weight[2] * (red[i] - surroundings[2]);
    };
    const ColourScore score = colour;
    for (std::size_t i = 0; i < count; ++i) {
      const float value = dot(score.along, i) - std::abs(dot(score.across, i)) -
                          std::abs(dot(score.second, i)) + outside[i];
      hue[i] = std::max(hue[i], value);
    }
  }
  return hue_;
}

}  // namespace nadir::vision
