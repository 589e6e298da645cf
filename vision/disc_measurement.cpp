#include "vision/disc_measurement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vision/disc_ring.h"
#include "vision/disc_surroundings.h"
#include "vision/disc_window.h"

namespace nadir::vision {
namespace {

// Low limits find the disc from afar; limits about one half put the edge where it is and leave out
// what lies behind a thin rim.
constexpr ShareLimits kFindLimits{0.10F, 0.60F};
constexpr ShareLimits kMeasureLimits{0.30F, 0.70F};
constexpr int kPatience = 3;  // iterations after which every row is looked at all the same
constexpr int kMostIterations = 8;
constexpr float kSettledPerRadius = 0.05F;  // a step of this size does not change the colours seen
constexpr float kSettled_px = 0.3F;
constexpr double kConverged_px = 0.04;
constexpr float kLeastContrast = 10.0F;  // grey levels
constexpr int kLeastInside = 6;          // pixels, for statistics of the disc's inside
// Explained sum of squares over scatter that chance may bring.
constexpr float kShadingOverScatter = 8.0F;
// Error in radii per relative change of light over a radius.
constexpr double kShadingError = 0.025;
constexpr double kSmallDisc = 24.0;  // pixels: smaller ones have no inside, only an edge

// Colours of the disc and of what is around it, as seen from the window's present place.
void read_colours(const cv::Mat& bgr, const LocalScale& scale, DiscWindow& window, Ring& ring,
                  const Bgr* plate, DiscMeasurement& disc) {
  sample_surroundings(bgr, scale, window.centre, window.radius_px, ring);
  disc.colour = middle_colour(bgr, scale, window.centre, window.radius_px);
  disc.surroundings = surroundings_of(ring, disc.colour, plate);
  window.surroundings = disc.surroundings;
  window.difference = disc.colour - disc.surroundings;
  disc.contrast = window.difference.norm();
  // Where nothing is known of the plate, a disc may still be far off and its own colour in the
  // ring.
  window.share_of = plate != nullptr ? share_function(ring, disc.surroundings, window.difference)
                                     : Bgr(window.difference / window.difference.squaredNorm());
}

// Takes over the light's slope as far as it is more than the pixels' scatter would make it.
void set_shading(const InsideShares& inside, DiscWindow& window) {
  if (inside.count < kLeastInside || inside.mean <= 0.0F) return;
  const float certain = std::max(0.0F, inside.explained - kShadingOverScatter * inside.scatter);
  const float trust = certain / (inside.explained + 1e-9F);
  window.slope_u = trust * inside.slope_u / inside.mean;
  window.slope_v = trust * inside.slope_v / inside.mean;
}

// Scatter of the surroundings' shares, robustly: half the ring may show something else.
double ring_deviation(const Ring& ring, const DiscWindow& w) {
  std::array<float, kRingSamples> deviation;
  for (int i = 0; i < kRingSamples; ++i) {
    const Bgr value(ring[0][i], ring[1][i], ring[2][i]);
    deviation[i] = std::abs(w.share_of.dot(value - w.surroundings));
  }
  const auto middle = deviation.begin() + kRingSamples / 2;
  std::nth_element(deviation.begin(), middle, deviation.end());
  return 1.4826 * static_cast<double>(*middle);  // median absolute deviation -> sigma
}

// What the pixel grid leaves: pixels on the edge, about sqrt(N) of them, are each misjudged a
// little.
double grid_variance_px2(double sampling_variance_px2, double pixels) {
  const double small = kSmallDisc / pixels;
  return sampling_variance_px2 / std::sqrt(pixels) * (1.0 + small * small);
}

// What noise does to the centre through the pixels on the edge, and what is left of a slope of
// light.
double centre_variance_px2(const WeightSums& sums, const InsideShares& inside, const Ring& ring,
                           const DiscWindow& window) {
  const double deviation = ring_deviation(ring, window);
  const double around = deviation * deviation;
  const double within = inside.count >= kLeastInside ? static_cast<double>(inside.scatter) : around;
  const double gain = 1.0 / static_cast<double>(window.limits.high - window.limits.low);
  // A pixel on the edge is as noisy as the mean of both sides. Half the squared distance is one
  // axis.
  const double noise = 0.5 * (around + within);
  const double by_noise = 0.5 * static_cast<double>(sums.edge_moment_px2) * gain * gain * noise /
                          (static_cast<double>(sums.weight) * static_cast<double>(sums.weight));
  const auto radius_px = static_cast<double>(window.radius_px);
  const double by_shading = kShadingError * radius_px * radius_px *
                            static_cast<double>(std::hypot(window.slope_u, window.slope_v));
  return by_noise + by_shading * by_shading;
}

bool reaches_over_border(const cv::Mat& bgr, const DiscWindow& window) {
  const double radius_px = window.radius_px;
  const PixelPoint& c = window.centre;
  return !(c.x() >= radius_px && c.y() >= radius_px && c.x() <= bgr.cols - 1 - radius_px &&
           c.y() <= bgr.rows - 1 - radius_px);
}

}  // namespace

MeasureOutcome measure_disc(const cv::Mat& bgr, const LocalScale& scale, double radius_m,
                            const PixelPoint& start, double sampling_variance_px2,
                            DiscMeasurement& disc, const Bgr* plate) {
  DiscWindow window;
  window.centre = start;
  window.radius_px = static_cast<float>(radius_m) * scale.scale_px_per_m;
  window.to_round = scale.metres_per_pixel * scale.scale_px_per_m;
  window.limits = kFindLimits;
  // To find a disc, some of its rows are enough. (To measure it they are too few: 0.04 px of
  // error.)
  window.row_step = std::max(1, static_cast<int>(std::sqrt(window.radius_px)));
  const double farthest_px = 1.5 * static_cast<double>(window.radius_px) + 1.0;
  WeightSums sums;
  InsideShares inside;
  Ring ring;
  const double settled_px =
      static_cast<double>(std::max(kSettled_px, kSettledPerRadius * window.radius_px));
  bool settled = false;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    if (reaches_over_border(bgr, window)) return MeasureOutcome::kOutsideImage;
    if (!settled) {  // colours seen from a wrong place are wrong
      read_colours(bgr, scale, window, ring, plate, disc);
      if (disc.contrast < static_cast<double>(kLeastContrast)) return MeasureOutcome::kWeakContrast;
    }
    if (iteration == kPatience) window.row_step = 1;
    sums = sum_weights(bgr, window);
    if (sums.weight < 1.0F) return MeasureOutcome::kWeakContrast;
    const PixelPoint step(sums.weight_u / sums.weight, sums.weight_v / sums.weight);
    window.centre += step;
    if ((window.centre - start).norm() > farthest_px) return MeasureOutcome::kDriftsAway;
    if (settled && step.norm() < kConverged_px) break;
    if (!settled && iteration + 1 < kMostIterations && step.norm() < settled_px) {
      settled = true;
      inside = inside_shares(bgr, window);
      set_shading(inside, window);
      window.limits = kMeasureLimits;
      window.row_step = 1;
    }
  }
  if (!settled) return MeasureOutcome::kDriftsAway;
  disc.centre_px = window.centre;
  disc.pixels = static_cast<double>(sums.weight);
  disc.expected_pixels = M_PI * static_cast<double>(window.radius_px * window.radius_px);
  disc.variance_px2 = centre_variance_px2(sums, inside, ring, window) +
                      grid_variance_px2(sampling_variance_px2, disc.pixels);
  return MeasureOutcome::kMeasured;
}

}  // namespace nadir::vision
