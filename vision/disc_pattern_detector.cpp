#include "vision/disc_pattern_detector.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "vision/disc_measurement.h"
#include "vision/disc_ring.h"
#include "vision/input/input_error.h"
#include "vision/mosaic_trace.h"
#include "vision/pattern_match.h"
#include "vision/prefetch.h"
#include "vision/sparse_search.h"

namespace nadir::vision {
namespace {

constexpr double kSmallestRadius_px = 1.2;
constexpr double kHueHalfWidth_rad = 0.70;
constexpr float kLeastHueShare = 0.2F;  // of the team's hue in the contrast
constexpr double kLeastArea = 0.4;      // soft pixel count over expected count
constexpr double kMostArea = 1.7;
constexpr double kLeastApart = 0.8;  // two discs' centres, over the sum of their radii
constexpr std::size_t kMostRejections = 256;
constexpr std::size_t kMostRobots = 256;
constexpr unsigned kFramesPerMosaicCheck = 16;  // a camera keeps its sensor
constexpr int kMostCandidates = 4000;           // a picture full of confetti must not take for ever

std::vector<ColourScore> centre_scores(const MarkerLayout& layout, const ColourClasses& colours) {
  std::vector<ColourScore> scores;
  for (const Team& team : layout.teams) {
    scores.push_back(colour_score(colours, team.centre_colour, kHueHalfWidth_rad));
  }
  return scores;
}

double radius_px(const DiscObservation& disc) { return std::sqrt(disc.expected_pixels / M_PI); }

bool overlap(const RobotObservation& a, const RobotObservation& b) {
  for (int i = 0; i < a.disc_count; ++i) {
    for (int j = 0; j < b.disc_count; ++j) {
      const double least_px = kLeastApart * (radius_px(a.discs[i]) + radius_px(b.discs[j]));
      const PixelPoint apart = a.discs[i].centre_px - b.discs[j].centre_px;
      if (apart.squaredNorm() < least_px * least_px) return true;
    }
  }
  return false;
}

}  // namespace

struct DiscPatternDetector::State {
  State(const MarkerLayout& marker_layout, const PixelScaleGrid& scale_grid,
        const ColourClasses& colours)
      : layout(marker_layout),
        scale(scale_grid),
        team_scores(centre_scores(layout, colours)),
        search(scale.width_px(), scale.height_px(),
               layout.centre_radius_m * scale.smallest_pixels_per_metre(),
               layout.centre_radius_m * scale.largest_pixels_per_metre(), team_scores),
        pattern(layout, colours) {
    shared.reserve(kMostRobots);
    for (const Disc& disc : layout.outer) {
      reach_m = std::max(reach_m, disc.position_robot_m.norm() + disc.radius_m);
    }
  }

  void fetch_robot(const cv::Mat& bgr, const PixelPoint& place) const;
  void mark_robot(const PixelPoint& place);
  void consider(const cv::Mat& bgr, const Seed& seed, DetectionResult& result);
  void reject(DetectionResult& result, const PixelPoint& place, RejectReason reason) const;
  void resolve_shared_discs(DetectionResult& result);
  void tidy_rejected(DetectionResult& result) const;

  MarkerLayout layout;
  PixelScaleGrid scale;
  std::vector<ColourScore> team_scores;
  SparseSearch search;
  PatternMatch pattern;
  int candidates = 0;
  double sampling_variance_px2 = kSamplingVariance_px2;
  unsigned frames = 0;
  std::vector<char> shared;
  double reach_m = 0.0;  ///< from the robot's origin to the rim of its outermost disc
};

void DiscPatternDetector::State::reject(DetectionResult& result, const PixelPoint& place,
                                        RejectReason reason) const {
  if (result.rejected.size() < kMostRejections) {
    result.rejected.push_back({place, reason});
  } else {
    ++result.rejected_not_listed;
  }
}

// Asks memory for the pixels that a robot at this place would cover, before they are needed.
void DiscPatternDetector::State::fetch_robot(const cv::Mat& bgr, const PixelPoint& place) const {
  SquareFetch(bgr, place, reach_m * scale.largest_pixels_per_metre()).all_rows();
}

void DiscPatternDetector::State::mark_robot(const PixelPoint& place) {
  const double radius_px = reach_m * static_cast<double>(local_scale(scale, place).scale_px_per_m);
  for (int colour = 0; colour < static_cast<int>(team_scores.size()); ++colour) {
    search.mark(place, radius_px, colour);
  }
}

void DiscPatternDetector::State::consider(const cv::Mat& bgr, const Seed& seed,
                                          DetectionResult& result) {
  const LocalScale local = local_scale(scale, seed.pixel);
  const double radius_px = layout.centre_radius_m * static_cast<double>(local.scale_px_per_m);
  if (++candidates > kMostCandidates) {
    return reject(result, seed.pixel, RejectReason::kTooManyCandidates);
  }
  const Bgr difference = glance_at_disc(bgr, local, layout.centre_radius_m, seed.pixel);
  if (team_scores[seed.colour](difference) < kLeastHueShare * difference.norm()) {
    search.mark(seed.pixel, 0.5 * radius_px, seed.colour);
    return reject(result, seed.pixel, RejectReason::kWeakContrast);
  }
  DiscMeasurement disc;
  const MeasureOutcome outcome =
      measure_disc(bgr, local, layout.centre_radius_m, seed.pixel, sampling_variance_px2, disc);
  search.mark(seed.pixel, 0.8 * radius_px, seed.colour);
  if (outcome != MeasureOutcome::kMeasured) {
    if (outcome == MeasureOutcome::kOutsideImage) {
      reject(result, seed.pixel, RejectReason::kOutsideImage);
    } else if (outcome == MeasureOutcome::kWeakContrast) {
      reject(result, seed.pixel, RejectReason::kWeakContrast);
    } else {
      reject(result, seed.pixel, RejectReason::kNotRound);
    }
    return;
  }
  search.mark(disc.centre_px, 1.3 * radius_px, seed.colour);
  const double area = disc.pixels / disc.expected_pixels;
  const float hue = team_scores[seed.colour](disc.colour - disc.surroundings);
  if (hue <= 0.0F) return reject(result, disc.centre_px, RejectReason::kWeakContrast);
  if (area < kLeastArea || area > kMostArea) {
    return reject(result, disc.centre_px, RejectReason::kWrongSize);
  }
  RobotObservation robot;
  RejectReason reason{};
  if (!pattern.match(bgr, local, disc, seed.colour, sampling_variance_px2, robot, reason)) {
    return reject(result, disc.centre_px, reason);
  }
  if (result.robots.size() >= kMostRobots) {
    return reject(result, disc.centre_px, RejectReason::kTooManyCandidates);
  }
  result.robots.push_back(robot);
}

// Discs do not overlap: of two robots whose discs would, the more confident one is there.
void DiscPatternDetector::State::resolve_shared_discs(DetectionResult& result) {
  auto& robots = result.robots;
  shared.assign(robots.size(), 0);
  const double far_px = 2.0 * reach_m * scale.largest_pixels_per_metre();
  for (std::size_t a = 0; a < robots.size(); ++a) {
    for (std::size_t b = a + 1; b < robots.size(); ++b) {
      const PixelPoint apart = robots[a].discs[0].centre_px - robots[b].discs[0].centre_px;
      if (apart.squaredNorm() > far_px * far_px || !overlap(robots[a], robots[b])) continue;
      shared[robots[a].confidence < robots[b].confidence ? a : b] = 1;
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (shared[i] != 0) {
      reject(result, robots[i].discs[0].centre_px, RejectReason::kSharedDisc);
    } else {
      if (kept != i) robots[kept] = robots[i];
      ++kept;
    }
  }
  robots.resize(kept);
}

// One line for each thing that was turned down: not for places on a robot that was found after all,
// and not again for the other pixels of the same thing.
void DiscPatternDetector::State::tidy_rejected(DetectionResult& result) const {
  auto& rejected = result.rejected;
  std::size_t kept = 0;
  for (const RejectedCandidate& each : rejected) {
    const double scale_px_per_m =
        static_cast<double>(local_scale(scale, each.centre_px).scale_px_per_m);
    const auto near = [&](const PixelPoint& place, double distance_m) {
      return (place - each.centre_px).norm() < distance_m * scale_px_per_m;
    };
    const auto first = rejected.begin();
    const bool known =
        std::any_of(result.robots.begin(), result.robots.end(),
                    [&](const auto& robot) { return near(robot.discs[0].centre_px, reach_m); }) ||
        std::any_of(first, first + static_cast<std::ptrdiff_t>(kept), [&](const auto& earlier) {
          return near(earlier.centre_px, 1.5 * layout.centre_radius_m);
        });
    if (!known) rejected[kept++] = each;
  }
  rejected.resize(kept);
}

DiscPatternDetector::DiscPatternDetector(const MarkerLayout& layout, const PixelScaleGrid& scale,
                                         const ColourClasses& colours) {
  double smallest_radius_m = layout.centre_radius_m;
  for (const Disc& disc : layout.outer)
    smallest_radius_m = std::min(smallest_radius_m, disc.radius_m);
  const double smallest_px = smallest_radius_m * scale.largest_pixels_per_metre();
  if (!(smallest_px >= kSmallestRadius_px)) {
    throw InputError(
        {layout.name, 0, 0},
        "its smallest disc has a radius of " + std::to_string(smallest_px) + " px in this camera",
        "use larger discs or a closer camera: at least " + std::to_string(kSmallestRadius_px) +
            " px are needed");
  }
  state_ = std::make_unique<State>(layout, scale, colours);
}

DiscPatternDetector::~DiscPatternDetector() = default;
DiscPatternDetector::DiscPatternDetector(DiscPatternDetector&&) noexcept = default;
DiscPatternDetector& DiscPatternDetector::operator=(DiscPatternDetector&&) noexcept = default;

void DiscPatternDetector::detect(const cv::Mat& bgr, DetectionResult& result) {
  constexpr RowBand kEverything;
  detect(bgr, {.bands = std::span(&kEverything, 1)}, result);
}

void DiscPatternDetector::detect(const cv::Mat& bgr, const SearchArea& area,
                                 DetectionResult& result) {
  if (bgr.type() != CV_8UC3 || bgr.cols != state_->scale.width_px() ||
      bgr.rows != state_->scale.height_px()) {
    throw std::invalid_argument("DiscPatternDetector: frame is not CV_8UC3 of the scale's size");
  }
  result.clear();
  result.robots.reserve(kMostRobots);
  result.rejected.reserve(kMostRejections);
  State& state = *state_;
  state.candidates = 0;
  if (state.frames++ % kFramesPerMosaicCheck == 0) {
    state.sampling_variance_px2 =
        looks_demosaiced(bgr) ? kDemosaicedSamplingVariance_px2 : kSamplingVariance_px2;
  }
  state.search.scan(bgr, area.bands);
  for (const PixelPoint& place : area.known) state.mark_robot(place);
  state.search.for_each_seed([&](const Seed& seed, const PixelPoint& next) {
    state.fetch_robot(bgr, next);
    state.consider(bgr, seed, result);
  });
  state.resolve_shared_discs(result);
  state.tidy_rejected(result);
}

}  // namespace nadir::vision
