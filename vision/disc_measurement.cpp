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
constexpr float kWindowMargin_px = 1.1F;  // the window's taper ends here, outside the edge
constexpr float kTaper_px = 0.8F;
// Shares below `low` count nothing, above `high` fully. Low limits find the disc from afar; limits
// about one half put the edge where it is and leave out what lies behind a thin rim.
struct ShareLimits {
  float low;
  float high;
};
constexpr ShareLimits kFindLimits{0.10F, 0.60F};
constexpr ShareLimits kMeasureLimits{0.30F, 0.70F};
constexpr float kDeep_px = 2.2F;      // well inside: this far from the edge
constexpr float kLeastInside = 6.0F;  // pixels, for statistics of the disc's inside
constexpr float kShadingOverScatter =
    8.0F;  // explained sum of squares over scatter that chance may bring
constexpr double kShadingError =
    0.10;  // px of centre error per relative change of brightness over a radius
// Pixels further from the line between disc and surroundings than this share of the contrast lose
// their weight, ...
constexpr float kForeignShare = 0.35F;
constexpr float kForeignLimit = 2.0F;    // ... all of it at sqrt(2) times that
constexpr double kSmallDisc = 12.0;      // pixels: smaller ones have no inside, only an edge
constexpr float kLeastContrast = 10.0F;  // grey levels
constexpr int kMostIterations = 8;
constexpr double kSettled_px = 0.3;
constexpr double kConverged_px = 0.02;

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
  float edge_moment =
      0.0F;  // sum of squared distance (mean of both axes) of pixels whose share is not limited
  float inside = 0.0F;  // number of pixels well inside, and sums over them
  float inside_u = 0.0F;
  float inside_v = 0.0F;
  float inside_u2 = 0.0F;
  float inside_v2 = 0.0F;
  float inside_share = 0.0F;
  float inside_share2 = 0.0F;
  float inside_share_u = 0.0F;
  float inside_share_v = 0.0F;
};

struct Window {
  PixelPoint centre;
  float radius_px;
  Eigen::Matrix2f to_round;  // pixel offset -> offset in which the disc is a circle of radius_px
  Bgr surroundings;
  Bgr difference;  // of the disc's colour from its surroundings
  ShareLimits limits;
  float slope_u;  // of the brightness inside the disc, share per pixel: light that falls off, a
                  // shadow's edge
  float slope_v;
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
  const float deep = std::max(0.0F, w.radius_px - kDeep_px);
  const float deep2 = deep * deep;
  const float share_gain = 1.0F / (w.limits.high - w.limits.low);
  const float per_contrast2 = 1.0F / w.difference.squaredNorm();
  const float per_foreign2 = per_contrast2 / (kForeignShare * kForeignShare);
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
      const float blue = pixel[0] - w.surroundings[0];
      const float green = pixel[1] - w.surroundings[1];
      const float red = pixel[2] - w.surroundings[2];
      const float along = w.difference[0] * blue + w.difference[1] * green + w.difference[2] * red;
      const float share = along * per_contrast2;
      // What is neither disc nor surroundings nor a mixture of both lies off the line between the
      // two.
      const float off_line2 = blue * blue + green * green + red * red - along * share;
      const float own = std::clamp(kForeignLimit - off_line2 * per_foreign2, 0.0F, 1.0F);
      const float lit = std::clamp(1.0F + w.slope_u * du + w.slope_v * dv, 0.3F, 1.7F);
      const float limited = (share / lit - w.limits.low) * share_gain;
      const float weight = taper * own * std::clamp(limited, 0.0F, 1.0F);
      sums.weight += weight;
      sums.weight_u += weight * du;
      sums.weight_v += weight * dv;
      if (limited > 0.0F && limited < 1.0F) sums.edge_moment += taper * taper * distance2;
      if (distance2 < deep2) {
        sums.inside += 1.0F;
        sums.inside_share += share;
        sums.inside_share2 += share * share;
        sums.inside_u += du;
        sums.inside_v += dv;
        sums.inside_u2 += du * du;
        sums.inside_v2 += dv * dv;
        sums.inside_share_u += share * du;
        sums.inside_share_v += share * dv;
      }
    }
  }
  return sums;
}

// Scatter of the surroundings' shares, robustly: half the ring may show something else.
float ring_deviation(const Ring& ring, const Window& w) {
  std::array<float, kRingSamples> deviation;
  const Bgr direction = w.difference / w.difference.squaredNorm();
  for (int i = 0; i < kRingSamples; ++i) {
    const Bgr value(ring[0][i], ring[1][i], ring[2][i]);
    deviation[i] = std::abs(direction.dot(value - w.surroundings));
  }
  const auto middle = deviation.begin() + kRingSamples / 2;
  std::nth_element(deviation.begin(), middle, deviation.end());
  return 1.4826F * *middle;
}

// How brightness changes across the disc: a straight line through the pixels well inside, as far as
// it is more than their scatter would make it.
void fit_shading(const WindowSums& sums, Window& window) {
  if (sums.inside < kLeastInside || sums.inside_share <= 0.0F) return;
  const float mean = sums.inside_share / sums.inside;
  const float slope_u = (sums.inside_share_u - mean * sums.inside_u) / sums.inside_u2;
  const float slope_v = (sums.inside_share_v - mean * sums.inside_v) / sums.inside_v2;
  const float explained =
      slope_u * slope_u * sums.inside_u2 + slope_v * slope_v * sums.inside_v2;  // sum of squares
  const float scatter =
      std::max(0.0F, sums.inside_share2 - sums.inside * mean * mean - explained) / sums.inside;
  const float trust =
      std::max(0.0F, explained - kShadingOverScatter * scatter) / (explained + 1e-9F);
  window.slope_u = trust * slope_u / mean;
  window.slope_v = trust * slope_v / mean;
}

double centre_variance_px2(const WindowSums& sums, const Window& window,
                           float ring_deviation_share) {
  const double around = static_cast<double>(ring_deviation_share) * ring_deviation_share;
  double inside = around;
  if (sums.inside >= kLeastInside) {
    const double mean = sums.inside_share / static_cast<double>(sums.inside);
    const double along_u = sums.inside_share_u - mean * sums.inside_u;
    const double along_v = sums.inside_share_v - mean * sums.inside_v;
    const double explained =
        along_u * along_u / sums.inside_u2 + along_v * along_v / sums.inside_v2;
    inside = std::max(0.0, (sums.inside_share2 - explained) / sums.inside - mean * mean);
  }
  const double gain = 1.0 / (window.limits.high - window.limits.low);
  // A pixel on the edge is as noisy as the mean of both sides.
  const double per_axis = 0.5 * sums.edge_moment * gain * gain * 0.5 * (around + inside) /
                          (static_cast<double>(sums.weight) * sums.weight);
  const double shading =
      kShadingError * window.radius_px * std::hypot(window.slope_u, window.slope_v);
  return per_axis + shading * shading;
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
                            const PixelPoint& start, double sampling_variance_px2,
                            DiscMeasurement& disc) {
  const float radius_px = static_cast<float>(radius_m) * scale.scale_px_per_m;
  Window window;
  window.centre = start;
  window.radius_px = radius_px;
  window.to_round = scale.metres_per_pixel * scale.scale_px_per_m;
  window.limits = kFindLimits;
  window.slope_u = 0.0F;
  window.slope_v = 0.0F;
  WindowSums sums;
  Ring ring;
  bool settled = false;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const PixelPoint& c = window.centre;
    if (c.x() < radius_px || c.y() < radius_px || c.x() > bgr.cols - 1 - radius_px ||
        c.y() > bgr.rows - 1 - radius_px) {
      return MeasureOutcome::kOutsideImage;
    }
    if (!settled) {  // colours seen from a wrong place are wrong
      sample_ring(bgr, scale, c, radius_px + kRingDistance_px, ring);
      disc.surroundings = median_of_ring(ring);
      disc.colour = middle_colour(bgr, scale, c, radius_px);
      window.surroundings = disc.surroundings;
      window.difference = disc.colour - disc.surroundings;
      disc.contrast = window.difference.norm();
      if (disc.contrast < kLeastContrast) return MeasureOutcome::kWeakContrast;
    }
    sums = pass_over_window(bgr, window);
    if (sums.weight < 1.0F) return MeasureOutcome::kWeakContrast;
    const PixelPoint step(sums.weight_u / sums.weight, sums.weight_v / sums.weight);
    window.centre += step;
    if ((window.centre - start).norm() > 1.5 * radius_px + 1.0) return MeasureOutcome::kDriftsAway;
    if (settled && step.norm() < kConverged_px) break;
    if (!settled && step.norm() < kSettled_px) {
      settled = true;
      window.limits = kMeasureLimits;
      fit_shading(sums, window);
    }
  }
  disc.centre_px = window.centre;
  disc.pixels = sums.weight;
  disc.expected_pixels = M_PI * radius_px * radius_px;
  disc.variance_px2 = centre_variance_px2(sums, window, ring_deviation(ring, window)) +
                      sampling_variance_px2 / disc.pixels * (1.0 + kSmallDisc / disc.pixels);
  return MeasureOutcome::kMeasured;
}

}  // namespace nadir::vision
