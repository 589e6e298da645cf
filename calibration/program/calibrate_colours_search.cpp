#include "calibration/program/calibrate_colours_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vision/disc_measurement.h"
#include "vision/disc_pattern_detector.h"
#include "vision/input/input_error.h"
#include "vision/local_scale.h"

namespace nadir::calibration {
namespace {

using vision::Bgr;
using vision::ColourClasses;
using vision::DetectionResult;
using vision::MarkerLayout;
using vision::PixelScaleGrid;
using Images = std::vector<cv::Mat>;

constexpr double kScaleStep = 1.15;  // a detector takes discs that are 20 % too large or small
constexpr double kSmallestRadius_px = 3.0;
constexpr std::size_t kProbes = 3;  // images for trying out scales and lights
constexpr int kMostRounds = 5;
/// Gains of blue and of red against green that are tried out: from cold to very warm light.
constexpr std::array<float, 5> kGains = {0.5F, 0.7F, 1.0F, 1.4F, 2.0F};

double smallest_radius_m(const MarkerLayout& layout) {
  double radius_m = layout.centre_radius_m;
  for (const vision::Disc& disc : layout.outer) radius_m = std::min(radius_m, disc.radius_m);
  return radius_m;
}

double reach_m(const MarkerLayout& layout) {
  double reach = layout.centre_radius_m;
  for (const vision::Disc& disc : layout.outer) {
    reach = std::max(reach, disc.position_robot_m.norm() + disc.radius_m);
  }
  return reach;
}

/// Of a camera that looks straight down: u along x, v against y.
PixelScaleGrid uniform_scale(const cv::Size& size, double pixels_per_metre) {
  Eigen::Matrix2d jacobian =
      Eigen::Vector2d(1.0 / pixels_per_metre, -1.0 / pixels_per_metre).asDiagonal();
  return {size.width, size.height, [&jacobian](const vision::PixelPoint&) { return jacobian; }};
}

struct Trial {
  PixelScaleGrid scale;
  ColourClasses classes;
  double score = 0.0;  ///< sum of the robots' confidences
};

double score(const Images& images, const MarkerLayout& layout, const PixelScaleGrid& scale,
             const ColourClasses& classes) {
  vision::DiscPatternDetector detector(layout, scale, classes);
  DetectionResult seen;
  double sum = 0.0;
  for (const cv::Mat& image : images) {
    detector.detect(image, seen);
    // A robot that is hardly believable still counts more than none.
    for (const vision::RobotObservation& robot : seen.robots) sum += 0.2 + robot.confidence;
  }
  return sum;
}

std::vector<PixelScaleGrid> possible_scales(const cv::Size& size, const MarkerLayout& layout) {
  const double low = kSmallestRadius_px / smallest_radius_m(layout);
  const double high = 0.25 * std::min(size.width, size.height) / reach_m(layout);
  std::vector<PixelScaleGrid> scales;
  for (double scale = low; scale <= std::max(low, high); scale *= kScaleStep) {
    scales.push_back(uniform_scale(size, scale));
  }
  return scales;
}

std::vector<ColourClasses> possible_lights() {
  std::vector<ColourClasses> lights = {vision::default_colour_classes()};
  for (const float blue : kGains) {
    for (const float red : kGains) {
      if (blue == 1.0F && red == 1.0F) continue;
      lights.push_back(lit_default_classes(Bgr(blue, 1.0F, red)));
    }
  }
  return lights;
}

/// The best of all scales in all lights given.
Trial best_trial(const Images& images, const MarkerLayout& layout,
                 const std::vector<PixelScaleGrid>& scales,
                 const std::vector<ColourClasses>& lights) {
  Trial best{scales.front(), lights.front(), 0.0};
  for (const ColourClasses& light : lights) {
    for (const PixelScaleGrid& scale : scales) {
      const double found = score(images, layout, scale, light);
      if (found > best.score) best = {scale, light, found};
    }
  }
  return best;
}

/// A few images, evenly out of all.
Images probes(const Images& images) {
  Images few;
  const std::size_t count = std::min(kProbes, images.size());
  for (std::size_t i = 0; i < count; ++i) few.push_back(images[i * images.size() / count]);
  return few;
}

void add_samples(const cv::Mat& image, const MarkerLayout& layout, const PixelScaleGrid& scale,
                 const vision::RobotObservation& robot, std::vector<ColourSample>& samples) {
  for (int i = 0; i < robot.disc_count; ++i) {
    const vision::Disc disc = layout.disc(i, robot.team, robot.identity);
    const vision::PixelPoint& centre_px = robot.discs[static_cast<std::size_t>(i)].centre_px;
    vision::DiscMeasurement seen;
    const auto outcome = vision::measure_disc(image, local_scale(scale, centre_px), disc.radius_m,
                                              centre_px, vision::kSamplingVariance_px2, seen);
    if (outcome != vision::MeasureOutcome::kMeasured) continue;
    samples.push_back({disc.colour, seen.colour, seen.surroundings});
  }
}

ColourSearchResult detect_all(const Images& images, const MarkerLayout& layout,
                              const PixelScaleGrid& scale, const ColourClasses& classes) {
  ColourSearchResult result{scale, classes, {}, {}, 0, 0};
  vision::DiscPatternDetector detector(layout, scale, classes);
  for (const cv::Mat& image : images) {
    DetectionResult seen;
    detector.detect(image, seen);
    for (const vision::RobotObservation& robot : seen.robots) {
      add_samples(image, layout, scale, robot, result.samples);
    }
    result.robots += static_cast<int>(seen.robots.size());
    result.frames.push_back(std::move(seen));
  }
  return result;
}

/// How much farther apart the discs of the robots found are than the layout and the scale say.
double size_ratio(const ColourSearchResult& found, const MarkerLayout& layout) {
  std::vector<double> ratios;
  for (const DetectionResult& frame : found.frames) {
    for (const vision::RobotObservation& robot : frame.robots) {
      const vision::PixelPoint& origin = robot.discs[0].centre_px;
      for (std::size_t i = 1; i < static_cast<std::size_t>(robot.disc_count); ++i) {
        const Eigen::Vector2d seen_m =
            found.scale.metres_per_pixel(origin) * (robot.discs[i].centre_px - origin);
        ratios.push_back(seen_m.norm() / layout.outer[i - 1].position_robot_m.norm());
      }
    }
  }
  if (ratios.empty()) return 1.0;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

Trial first_trial(const Images& images, const MarkerLayout& layout,
                  const std::optional<PixelScaleGrid>& scale) {
  const Images few = probes(images);
  if (scale) return best_trial(few, layout, {*scale}, possible_lights());
  const auto scales = possible_scales(images.front().size(), layout);
  Trial best = best_trial(few, layout, scales, {vision::default_colour_classes()});
  // The scale is known if anything was seen; otherwise every light may be the right one at every
  // scale.
  best = best.score > 0.0 ? best_trial(few, layout, {best.scale}, possible_lights())
                          : best_trial({few.front()}, layout, scales, possible_lights());
  if (best.score == 0.0) return best;
  const double ratio = size_ratio(detect_all(few, layout, best.scale, best.classes), layout);
  const double metres_per_pixel = best.scale.metres_per_pixel({0, 0})(0, 0);
  best.scale = uniform_scale(images.front().size(), ratio / metres_per_pixel);
  return best;
}

}  // namespace

ColourSearchResult search_colours(const Images& images, const MarkerLayout& layout,
                                  const std::optional<PixelScaleGrid>& scale,
                                  const std::string& files) {
  const Trial start = first_trial(images, layout, scale);
  ColourSearchResult best = detect_all(images, layout, start.scale, start.classes);
  if (best.robots == 0) {
    throw vision::InputError(
        {files}, "no robot of layout '" + layout.name + "' is seen",
        scale ? "check that layout and calibration are those of the pictures"
              : "check the layout, or give --calibration, from which the robots' size follows");
  }
  for (int round = 0; round < kMostRounds; ++round) {
    const ColourClasses classes = classes_from(study_colours(best.samples));
    ColourSearchResult next = detect_all(images, layout, start.scale, classes);
    if (next.robots < best.robots) break;
    const bool settled = next.robots == best.robots && round > 0;
    best = std::move(next);
    if (settled) break;
  }
  best.robots_by_default =
      detect_all(images, layout, start.scale, vision::default_colour_classes()).robots;
  return best;
}

}  // namespace nadir::calibration
