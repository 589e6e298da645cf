#include "vision/pattern_match.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace nadir::vision {
namespace {

constexpr double kHueHalfWidth_rad = 1.0;
// Step of the headings over the angle that an outer disc's radius takes at its distance.
constexpr double kHeadingStepPerDisc = 0.45;
// An outer disc must have this share of the centre disc's contrast in its own hue.
constexpr float kLeastHueShare = 0.12F;
constexpr float kLeastHue = 6.0F;  // grey levels
// Soft pixel count over expected count.
constexpr double kLeastArea = 0.4;
constexpr double kMostArea = 2.0;
constexpr int kMostNeighbours = 3;           // on each side of a heading
constexpr double kTolerancePerRadius = 0.2;  // of the layout's fit
constexpr double kTolerance_px = 0.3;

Eigen::Vector2f turned(const Eigen::Vector2f& direction, const Eigen::Vector2f& p) {
  return {direction.x() * p.x() - direction.y() * p.y(),
          direction.y() * p.x() + direction.x() * p.y()};
}

}  // namespace

PatternMatch::PatternMatch(const MarkerLayout& layout, const ColourClasses& colours)
    : layout_(layout) {
  double smallest_angle_rad = M_PI;
  double smallest_radius_m = layout.centre_radius_m;
  for (std::size_t i = 0; i < layout.outer.size(); ++i) {
    const Disc& disc = layout.outer[i];
    OuterDisc outer;
    outer.position_m = disc.position_robot_m.cast<float>();
    outer.radius_m = static_cast<float>(disc.radius_m);
    if (layout.is_anonymous()) outer.colours = {disc.colour};
    for (const Identity& identity : layout.identities) {
      const Colour colour = identity.outer_colours[i];
      if (std::find(outer.colours.begin(), outer.colours.end(), colour) == outer.colours.end()) {
        outer.colours.push_back(colour);
      }
    }
    for (const Colour colour : outer.colours) {
      outer.scores.push_back(colour_score(colours, colour, kHueHalfWidth_rad));
    }
    smallest_angle_rad =
        std::min(smallest_angle_rad, std::atan2(disc.radius_m, disc.position_robot_m.norm()));
    smallest_radius_m = std::min(smallest_radius_m, disc.radius_m);
    outer_.push_back(std::move(outer));
  }
  tolerance_m_ = kTolerancePerRadius * smallest_radius_m;
  const int count =
      static_cast<int>(std::ceil(2.0 * M_PI / (2.0 * kHeadingStepPerDisc * smallest_angle_rad)));
  for (int i = 0; i < count; ++i) {
    const double heading_rad = 2.0 * M_PI * i / count;
    headings_.emplace_back(std::cos(heading_rad), std::sin(heading_rad));
  }
  for (const OuterDisc& outer : outer_) {
    std::vector<Eigen::Vector2f> offsets_m;
    for (const Eigen::Vector2f& heading : headings_) {
      offsets_m.push_back(turned(heading, outer.position_m));
    }
    probes_.emplace_back(offsets_m, outer.scores);
  }
  evidence_.resize(headings_.size());
}

// The headings that are tried lie so close that the right one has neighbours that have all their
// discs too, if only near the rims: the mean of these neighbours is nearer to the truth than any.
PatternMatch::Heading PatternMatch::best_heading(const cv::Mat& bgr, const LocalScale& scale,
                                                 const DiscMeasurement& centre) {
  Heading heading;
  const std::size_t count = headings_.size();
  std::fill(evidence_.begin(), evidence_.end(), Evidence{1e9F, 0.0F});
  for (HueProbe& probe : probes_) {
    const std::vector<float>& hues = probe.look(bgr, scale, centre.centre_px, centre.surroundings);
    for (std::size_t i = 0; i < count; ++i) {
      evidence_[i].worst = std::min(evidence_[i].worst, hues[i]);
      evidence_[i].sum += hues[i];
    }
  }
  // The worst disc decides whether the heading can be; the sum which of those fits best.
  std::size_t best = count;
  for (std::size_t i = 0; i < count; ++i) {
    heading.any_outside = heading.any_outside || evidence_[i].worst <= HueProbe::kOutside / 2;
    if (evidence_[i].worst < kLeastHue) continue;
    if (best == count ||
        evidence_[i].worst + evidence_[i].sum > evidence_[best].worst + evidence_[best].sum) {
      best = i;
    }
  }
  if (best == count) return heading;
  heading.score = evidence_[best].worst;
  heading.direction = heading.score * headings_[best];
  const auto add_neighbours = [&](std::size_t step) {
    std::size_t i = (best + step) % count;
    for (int n = 0; n < kMostNeighbours && evidence_[i].worst >= kLeastHue; ++n) {
      heading.direction += evidence_[i].worst * headings_[i];
      i = (i + step) % count;
    }
  };
  add_neighbours(1);
  add_neighbours(count - 1);
  heading.direction.normalize();
  return heading;
}

// Every disc that was measured tells the direction better to the next.
bool PatternMatch::measure_outer_discs(const cv::Mat& bgr, const LocalScale& scale,
                                       Eigen::Vector2f direction, double sampling_variance_px2,
                                       std::array<DiscMeasurement, kMaxDiscs>& discs,
                                       RejectReason& reason) const {
  Eigen::Vector2f direction_sum = Eigen::Vector2f::Zero();
  for (std::size_t i = 0; i < outer_.size(); ++i) {
    const Eigen::Vector2f& p = outer_[i].position_m;
    const Eigen::Vector2f offset_px = scale.pixels_per_metre * turned(direction, p);
    DiscMeasurement& disc = discs[i + 1];
    const PixelPoint start = discs[0].centre_px + offset_px.cast<double>();
    const MeasureOutcome outcome = measure_disc(
        bgr, scale, outer_[i].radius_m, start, sampling_variance_px2, disc, &discs[0].surroundings);
    if (outcome == MeasureOutcome::kOutsideImage) reason = RejectReason::kOutsideImage;
    if (outcome != MeasureOutcome::kMeasured) return false;
    const double area = disc.pixels / disc.expected_pixels;
    if (area < kLeastArea || area > kMostArea) return false;
    const Eigen::Vector2f seen_m =
        scale.metres_per_pixel * (disc.centre_px - discs[0].centre_px).cast<float>();
    direction_sum += turned({p.x(), -p.y()}, seen_m);
    direction = direction_sum.normalized();
  }
  return true;
}

PatternMatch::Reading PatternMatch::read_colour(const OuterDisc& outer,
                                                const Bgr& difference) const {
  Reading reading;
  float first = -1e9F;
  float second = -1e9F;
  for (std::size_t i = 0; i < outer.colours.size(); ++i) {
    const float score = outer.scores[i](difference);
    if (score > first) {
      second = first;
      first = score;
      reading.colour = outer.colours[i];
    } else {
      second = std::max(second, score);
    }
  }
  reading.score = first;
  if (outer.colours.size() > 1) {
    reading.margin =
        std::clamp((first - second) / (std::abs(first) + std::abs(second) + 1.0F), 0.0F, 1.0F);
  }
  return reading;
}

int PatternMatch::find_identity(const RobotObservation& robot) const {
  for (std::size_t identity = 0; identity < layout_.identities.size(); ++identity) {
    const std::vector<Colour>& colours = layout_.identities[identity].outer_colours;
    bool equal = true;
    for (std::size_t i = 0; equal && i < colours.size(); ++i) {
      equal = colours[i] == robot.discs[i + 1].colour;
    }
    if (equal) return static_cast<int>(identity);
  }
  return -1;
}

// RMS distance of the measured discs from the rigidly moved layout, in pixels.
double PatternMatch::fit_error_px(const LocalScale& scale, const RobotObservation& robot) const {
  const int n = robot.disc_count;
  std::array<Eigen::Vector2d, kMaxDiscs> seen;
  std::array<Eigen::Vector2d, kMaxDiscs> wanted;
  Eigen::Vector2d seen_mean = Eigen::Vector2d::Zero();
  Eigen::Vector2d wanted_mean = Eigen::Vector2d::Zero();
  for (int i = 0; i < n; ++i) {
    seen[i] = scale.metres_per_pixel.cast<double>() *
              (robot.discs[i].centre_px - robot.discs[0].centre_px);
    wanted[i] =
        i == 0 ? Eigen::Vector2d::Zero() : Eigen::Vector2d(layout_.outer[i - 1].position_robot_m);
    seen_mean += seen[i] / n;
    wanted_mean += wanted[i] / n;
  }
  double cosine = 0.0;
  double sine = 0.0;
  for (int i = 0; i < n; ++i) {
    seen[i] -= seen_mean;
    wanted[i] -= wanted_mean;
    cosine += wanted[i].dot(seen[i]);
    sine += wanted[i].x() * seen[i].y() - wanted[i].y() * seen[i].x();
  }
  const double length = std::hypot(cosine, sine);
  if (length <= 0.0) return 1e9;
  cosine /= length;
  sine /= length;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector2d moved(cosine * wanted[i].x() - sine * wanted[i].y(),
                                sine * wanted[i].x() + cosine * wanted[i].y());
    sum += (seen[i] - moved).squaredNorm();
  }
  return std::sqrt(sum / n) * static_cast<double>(scale.scale_px_per_m);
}

bool PatternMatch::match(const cv::Mat& bgr, const LocalScale& scale, const DiscMeasurement& centre,
                         int team, double sampling_variance_px2, RobotObservation& robot,
                         RejectReason& reason) {
  const Heading heading = best_heading(bgr, scale, centre);
  reason = heading.any_outside ? RejectReason::kOutsideImage : RejectReason::kNoHeadingMarker;
  if (heading.score <= 0.0F ||
      heading.score < kLeastHueShare * static_cast<float>(centre.contrast)) {
    return false;
  }
  std::array<DiscMeasurement, kMaxDiscs> discs;
  discs[0] = centre;
  reason = RejectReason::kPatternDoesNotFit;
  if (!measure_outer_discs(bgr, scale, heading.direction, sampling_variance_px2, discs, reason)) {
    return false;
  }

  robot.team = team;
  robot.identity = -1;
  robot.disc_count = layout_.disc_count();
  float margin = 1.0F;
  double worst_area = 1.0;
  for (int i = 0; i < robot.disc_count; ++i) {
    const DiscMeasurement& disc = discs[i];
    DiscObservation& seen = robot.discs[i];
    seen.centre_px = disc.centre_px;
    seen.pixels = disc.pixels;
    seen.expected_pixels = disc.expected_pixels;
    seen.variance_px2 = disc.variance_px2;
    seen.contrast = disc.contrast;
    seen.colour = layout_.teams[team].centre_colour;
    const double area = disc.pixels / disc.expected_pixels;
    worst_area = std::min(worst_area, std::min(area, 1.0 / area));
    if (i == 0) continue;
    const Reading reading = read_colour(outer_[i - 1], disc.colour - disc.surroundings);
    if (reading.score < kLeastHue) return false;
    seen.colour = reading.colour;
    margin = std::min(margin, reading.margin);
  }
  robot.fit_error_px = fit_error_px(scale, robot);
  const double tolerance_px =
      kTolerance_px + tolerance_m_ * static_cast<double>(scale.scale_px_per_m);
  if (robot.fit_error_px > tolerance_px) return false;
  if (!layout_.is_anonymous()) {
    reason = RejectReason::kUnknownIdentity;
    robot.identity = find_identity(robot);
    if (robot.identity < 0) return false;
  }
  const double fit = robot.fit_error_px / tolerance_px;
  robot.confidence = static_cast<double>(margin) * std::sqrt(worst_area) * (1.0 - 0.5 * fit * fit);
  return true;
}

}  // namespace nadir::vision
