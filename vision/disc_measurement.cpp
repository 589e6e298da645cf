#include "vision/disc_measurement.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace nadir::vision {
namespace {

constexpr int kRingSamples = 16;
constexpr float kRingDistance_px = 2.0F;  // of the ring of surroundings from the disc's edge
constexpr float kWindowMargin_px = 1.8F;  // the window's taper ends here, outside the edge
constexpr float kTaper_px = 1.0F;
constexpr float kShareLow = 0.10F;       // shares below count nothing, ...
constexpr float kShareHigh = 0.60F;      // ... above count fully
constexpr float kLeastContrast = 10.0F;  // grey levels
constexpr int kMostIterations = 5;
constexpr double kConverged_px = 0.02;
constexpr double kFloorVariance_px2 = 1.0e-4;  // (0.01 px)^2: sampling, point spread, demosaicing

struct UnitVector {
  float x;
  float y;
};

std::array<UnitVector, kRingSamples> make_directions() {
  std::array<UnitVector, kRingSamples> directions{};
  for (int i = 0; i < kRingSamples; ++i) {
    const double angle_rad = 2.0 * M_PI * i / kRingSamples;
    directions[i] = {static_cast<float>(std::cos(angle_rad)),
                     static_cast<float>(std::sin(angle_rad))};
  }
  return directions;
}
const std::array<UnitVector, kRingSamples> kDirections = make_directions();

const std::uint8_t* nearest_pixel(const cv::Mat& bgr, float u_px, float v_px) {
  const int u = std::clamp(static_cast<int>(u_px + 0.5F), 0, bgr.cols - 1);
  const int v = std::clamp(static_cast<int>(v_px + 0.5F), 0, bgr.rows - 1);
  return bgr.ptr<std::uint8_t>(v) + 3 * u;
}

using Ring = std::array<std::array<std::uint8_t, kRingSamples>, 3>;

// Pixels at `radius_px` (in units of the local scale) from the centre, all directions of the plane.
void sample_ring(const cv::Mat& bgr, const LocalScale& scale, const PixelPoint& centre,
                 float radius_px, Ring& ring) {
  const Eigen::Matrix2f axes = scale.pixels_per_metre * (radius_px / scale.scale_px_per_m);
  const auto u = static_cast<float>(centre.x());
  const auto v = static_cast<float>(centre.y());
  for (int i = 0; i < kRingSamples; ++i) {
    const UnitVector d = kDirections[i];
    const std::uint8_t* pixel = nearest_pixel(bgr, u + axes(0, 0) * d.x + axes(0, 1) * d.y,
                                              v + axes(1, 0) * d.x + axes(1, 1) * d.y);
    for (int channel = 0; channel < 3; ++channel) ring[channel][i] = pixel[channel];
  }
}

Bgr median_of_ring(const Ring& ring) {
  Bgr median;
  for (int channel = 0; channel < 3; ++channel) {
    auto values = ring[channel];
    const auto middle = values.begin() + kRingSamples / 2;
    std::nth_element(values.begin(), middle, values.end());
    median[channel] = *middle;
  }
  return median;
}

// Mean of the disc's middle: the centre and eight pixels half a radius from it.
Bgr middle_colour(const cv::Mat& bgr, const LocalScale& scale, const PixelPoint& centre,
                  float radius_px) {
  Ring ring;
  sample_ring(bgr, scale, centre, 0.5F * radius_px, ring);
  const std::uint8_t* pixel =
      nearest_pixel(bgr, static_cast<float>(centre.x()), static_cast<float>(centre.y()));
  Bgr sum(pixel[0], pixel[1], pixel[2]);
  for (int i = 0; i < kRingSamples; i += 2) sum += Bgr(ring[0][i], ring[1][i], ring[2][i]);
  return sum / (1.0F + kRingSamples / 2);
}

// What one pass over the window yields; moments are about the pass's centre.
struct WindowSums {
  float weight = 0.0F;
  float weight_u = 0.0F;
  float weight_v = 0.0F;
  float share = 0.0F;  // soft pixel count
  float edge_moment =
      0.0F;  // sum of squared distance (mean of both axes) of pixels whose share is not limited
  float inside = 0.0F;  // pixels well inside, their shares and squares and first moments
  float inside_share = 0.0F;
  float inside_share2 = 0.0F;
};

struct Window {
  PixelPoint centre;
  float radius_px;
  Eigen::Matrix2f to_round;  // pixel offset -> offset in which the disc is a circle of radius_px
  Bgr direction;             // projection on the colour line; share = direction . value - offset
  float offset;
};

#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
__attribute__((target_clones("avx2,fma", "default")))
#endif
WindowSums
pass_over_window(const cv::Mat& bgr, const Window& w) {
  WindowSums sums;
  const float outer = w.radius_px + kWindowMargin_px;
  const float outer2 = outer * outer;
  const float inner = outer - kTaper_px;
  const float taper_gain = 1.0F / (outer2 - inner * inner);
  const float deep = std::max(0.0F, w.radius_px - 1.8F);
  const float deep2 = deep * deep;
  const float share_gain = 1.0F / (kShareHigh - kShareLow);
  const float half_u = outer * std::max(1.0F, 1.0F / w.to_round.col(0).norm());
  const float half_v = outer * std::max(1.0F, 1.0F / w.to_round.col(1).norm());
  const auto cu = static_cast<float>(w.centre.x());
  const auto cv_ = static_cast<float>(w.centre.y());
  const int u_begin = std::max(0, static_cast<int>(std::ceil(cu - half_u)));
  const int u_end = std::min(bgr.cols - 1, static_cast<int>(std::floor(cu + half_u)));
  const int v_begin = std::max(0, static_cast<int>(std::ceil(cv_ - half_v)));
  const int v_end = std::min(bgr.rows - 1, static_cast<int>(std::floor(cv_ + half_v)));
  for (int v = v_begin; v <= v_end; ++v) {
    const std::uint8_t* pixel = bgr.ptr<std::uint8_t>(v) + 3 * u_begin;
    const float dv = static_cast<float>(v) - cv_;
    for (int u = u_begin; u <= u_end; ++u, pixel += 3) {
      const float du = static_cast<float>(u) - cu;
      const float x = w.to_round(0, 0) * du + w.to_round(0, 1) * dv;
      const float y = w.to_round(1, 0) * du + w.to_round(1, 1) * dv;
      const float distance2 = x * x + y * y;
      const float taper = std::min(1.0F, (outer2 - distance2) * taper_gain);
      if (taper <= 0.0F) continue;
      const float share = w.direction[0] * pixel[0] + w.direction[1] * pixel[1] +
                          w.direction[2] * pixel[2] - w.offset;
      const float limited = (share - kShareLow) * share_gain;
      const float weight = taper * std::clamp(limited, 0.0F, 1.0F);
      sums.weight += weight;
      sums.weight_u += weight * du;
      sums.weight_v += weight * dv;
      sums.share += taper * std::clamp(share, 0.0F, 1.0F);
      if (limited > 0.0F && limited < 1.0F) sums.edge_moment += taper * taper * distance2;
      if (distance2 < deep2) {
        sums.inside += 1.0F;
        sums.inside_share += share;
        sums.inside_share2 += share * share;
      }
    }
  }
  return sums;
}

// Scatter of the surroundings' shares, robustly: half the ring may show something else.
float ring_deviation(const Ring& ring, const Window& w) {
  std::array<float, kRingSamples> deviation;
  for (int i = 0; i < kRingSamples; ++i) {
    deviation[i] = std::abs(w.direction[0] * ring[0][i] + w.direction[1] * ring[1][i] +
                            w.direction[2] * ring[2][i] - w.offset);
  }
  const auto middle = deviation.begin() + kRingSamples / 2;
  std::nth_element(deviation.begin(), middle, deviation.end());
  return 1.4826F * *middle;
}

double centre_variance_px2(const WindowSums& sums, float ring_deviation_share) {
  double inside_variance = 0.0;
  if (sums.inside >= 4.0F) {
    const double mean = sums.inside_share / sums.inside;
    inside_variance =
        std::max(0.0, sums.inside_share2 / static_cast<double>(sums.inside) - mean * mean);
  }
  const double noise2 =
      std::max(static_cast<double>(ring_deviation_share) * ring_deviation_share, inside_variance);
  const double gain = 1.0 / (kShareHigh - kShareLow);
  const double per_axis = 0.5 * sums.edge_moment * gain * gain * noise2 /
                          (static_cast<double>(sums.weight) * sums.weight);
  return per_axis + kFloorVariance_px2;
}

}  // namespace

LocalScale local_scale(const PixelScaleGrid& grid, const PixelPoint& pixel) {
  LocalScale scale;
  scale.metres_per_pixel = grid.metres_per_pixel(pixel).cast<float>();
  scale.pixels_per_metre = scale.metres_per_pixel.inverse();
  scale.scale_px_per_m = std::sqrt(std::abs(scale.pixels_per_metre.determinant()));
  return scale;
}

MeasureOutcome measure_disc(const cv::Mat& bgr, const LocalScale& scale, double radius_m,
                            const PixelPoint& start, DiscMeasurement& disc) {
  const float radius_px = static_cast<float>(radius_m) * scale.scale_px_per_m;
  Window window;
  window.centre = start;
  window.radius_px = radius_px;
  window.to_round = scale.metres_per_pixel * scale.scale_px_per_m;
  WindowSums sums;
  Ring ring;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const PixelPoint& c = window.centre;
    if (c.x() < radius_px || c.y() < radius_px || c.x() > bgr.cols - 1 - radius_px ||
        c.y() > bgr.rows - 1 - radius_px) {
      return MeasureOutcome::kOutsideImage;
    }
    if (iteration < 3) {  // the colours settle before the place does
      sample_ring(bgr, scale, c, radius_px + kRingDistance_px, ring);
      disc.surroundings = median_of_ring(ring);
      disc.colour = middle_colour(bgr, scale, c, radius_px);
      const Bgr difference = disc.colour - disc.surroundings;
      disc.contrast = difference.norm();
      if (disc.contrast < kLeastContrast) return MeasureOutcome::kWeakContrast;
      window.direction = difference / difference.squaredNorm();
      window.offset = window.direction.dot(disc.surroundings);
    }
    sums = pass_over_window(bgr, window);
    if (sums.weight < 1.0F) return MeasureOutcome::kWeakContrast;
    const PixelPoint step(sums.weight_u / sums.weight, sums.weight_v / sums.weight);
    window.centre += step;
    if ((window.centre - start).norm() > 1.5 * radius_px + 1.0) return MeasureOutcome::kDriftsAway;
    if (step.norm() < kConverged_px) break;
  }
  disc.centre_px = window.centre;
  disc.pixels = sums.share;
  disc.expected_pixels = M_PI * radius_px * radius_px;
  disc.variance_px2 = centre_variance_px2(sums, ring_deviation(ring, window));
  return MeasureOutcome::kMeasured;
}

}  // namespace nadir::vision
