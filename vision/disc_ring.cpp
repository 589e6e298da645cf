#include "vision/disc_ring.h"

#include <algorithm>
#include <cmath>

#include "vision/vector_clones.h"

namespace nadir::vision {
namespace {

constexpr float kMiddleSamples = 1.0F + 0.5F * kRingSamples;
constexpr float kRingDistance_px = 2.0F;  // of the ring of surroundings from the disc's edge

using Sixteen = std::array<float, kRingSamples>;

Sixteen directions(double (*component)(double)) {
  Sixteen values{};
  for (int i = 0; i < kRingSamples; ++i) {
    values[i] = static_cast<float>(component(2.0 * M_PI * i / kRingSamples));
  }
  return values;
}
const Sixteen kDirectionX = directions([](double angle_rad) { return std::cos(angle_rad); });
const Sixteen kDirectionY = directions([](double angle_rad) { return std::sin(angle_rad); });

const std::uint8_t* nearest_pixel(const cv::Mat& bgr, float u_px, float v_px) {
  const int u = std::clamp(static_cast<int>(u_px + 0.5F), 0, bgr.cols - 1);
  const int v = std::clamp(static_cast<int>(v_px + 0.5F), 0, bgr.rows - 1);
  return bgr.ptr<std::uint8_t>(v) + 3 * u;
}

// Rank by counting: sixteen bytes at once, and no branches.
inline std::uint8_t median_of(const std::array<std::uint8_t, kRingSamples>& values) {
  std::array<std::uint8_t, kRingSamples> not_larger{};  // for each value, how many are not larger
  for (const std::uint8_t value : values) {
    for (int i = 0; i < kRingSamples; ++i) not_larger[i] += value <= values[i] ? 1 : 0;
  }
  std::uint8_t median = 255;  // the smallest value with at least half of the others below it
  for (int i = 0; i < kRingSamples; ++i) {
    median = std::min(median, not_larger[i] > kRingSamples / 2 ? values[i] : std::uint8_t{255});
  }
  return median;
}

}  // namespace

NADIR_VECTOR_CLONES
void sample_ring(const cv::Mat& bgr, const LocalScale& scale, const PixelPoint& centre,
                 float radius_px, Ring& ring) {
  const Eigen::Matrix2f axes = scale.pixels_per_metre * (radius_px / scale.scale_px_per_m);
  const float ux = axes(0, 0);
  const float uy = axes(0, 1);
  const float vx = axes(1, 0);
  const float vy = axes(1, 1);
  const float u0 =
      static_cast<float>(centre.x()) + 0.5F;  // truncation then rounds to the nearest pixel
  const float v0 = static_cast<float>(centre.y()) + 0.5F;
  const int right = bgr.cols - 1;
  const int bottom = bgr.rows - 1;
  const int row_bytes = static_cast<int>(bgr.step);
  std::array<int, kRingSamples> place;
  for (int i = 0; i < kRingSamples; ++i) {
    const int u = static_cast<int>(u0 + ux * kDirectionX[i] + uy * kDirectionY[i]);
    const int v = static_cast<int>(v0 + vx * kDirectionX[i] + vy * kDirectionY[i]);
    place[i] = std::min(std::max(v, 0), bottom) * row_bytes + 3 * std::min(std::max(u, 0), right);
  }
  for (int i = 0; i < kRingSamples; ++i) {
    const std::uint8_t* pixel = bgr.data + place[i];
    ring[0][i] = pixel[0];
    ring[1][i] = pixel[1];
    ring[2][i] = pixel[2];
  }
}

void sample_surroundings(const cv::Mat& bgr, const LocalScale& scale, const PixelPoint& centre,
                         float disc_radius_px, Ring& ring) {
  sample_ring(bgr, scale, centre, disc_radius_px + kRingDistance_px, ring);
}

NADIR_VECTOR_CLONES
Bgr median_of_ring(const Ring& ring) {
  return {static_cast<float>(median_of(ring[0])), static_cast<float>(median_of(ring[1])),
          static_cast<float>(median_of(ring[2]))};
}

Bgr middle_colour(const cv::Mat& bgr, const LocalScale& scale, const PixelPoint& centre,
                  float radius_px) {
  Ring ring;
  sample_ring(bgr, scale, centre, 0.5F * radius_px, ring);
  const std::uint8_t* pixel =
      nearest_pixel(bgr, static_cast<float>(centre.x()), static_cast<float>(centre.y()));
  std::array<int, 3> sum = {pixel[0], pixel[1], pixel[2]};
  for (int channel = 0; channel < 3; ++channel) {
    for (int i = 0; i < kRingSamples; i += 2) sum[channel] += ring[channel][i];
  }
  return Bgr(static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])) /
         kMiddleSamples;
}

Bgr glance_at_disc(const cv::Mat& bgr, const LocalScale& scale, double radius_m,
                   const PixelPoint& centre) {
  const float radius_px = static_cast<float>(radius_m) * scale.scale_px_per_m;
  Ring ring;
  sample_surroundings(bgr, scale, centre, radius_px, ring);
  return middle_colour(bgr, scale, centre, radius_px) - median_of_ring(ring);
}

}  // namespace nadir::vision
