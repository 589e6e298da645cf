#include "calibration/colours/colours_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <string>

namespace nadir::calibration {
namespace {

using vision::Bgr;
using vision::Colour;

/// Hues further from a class than this belong to nobody; the detector's own limit for centre discs.
constexpr double kHueHalfWidth_rad = 0.70;
constexpr float kLeastScore = 10.0F;  // grey levels
constexpr float kDimming = 0.35F;     // of the pixels that belong to no class
constexpr int kDrawShift = 3;         // cv's drawing in eighths of a pixel

struct Painter {
  Colour colour;
  vision::ColourScore score;
  Bgr paint;
  float full_score;  ///< of the class's own discs
};

/// A painter, and how much of its colour a pixel has: 1 as much as the robots' discs.
struct Stroke {
  const Painter* painter = nullptr;
  float strength = 0.0F;
};

std::vector<Painter> painters(const std::vector<Colour>& colours,
                              const vision::ColourClasses& classes) {
  const vision::ColourClasses pure = vision::default_colour_classes();
  std::vector<Painter> all;
  for (const Colour colour : colours) {
    if (!has_hue(colour)) continue;
    const auto score = vision::colour_score(classes, colour, kHueHalfWidth_rad);
    all.push_back(
        {colour, score, pure.of(colour), std::max(kLeastScore, score(classes.of(colour)))});
  }
  return all;
}

/// The painter whose colour the pixel has, or none.
Stroke stroke_of(const std::vector<Painter>& all, const Bgr& difference) {
  Stroke best;
  float score = std::max(kLeastScore, 0.15F * difference.norm());
  for (const Painter& painter : all) {
    const float own = painter.score(difference);
    if (own <= score) continue;
    score = own;
    best = {&painter, std::clamp(own / painter.full_score, 0.0F, 1.0F)};
  }
  return best;
}

cv::Vec3b painted(const Bgr& value, const Stroke& stroke) {
  Bgr ink = Bgr::Constant(kDimming * value.mean());
  if (stroke.painter != nullptr) {
    // The square sets the robots' discs off from a floor of a like hue.
    ink += stroke.strength * stroke.strength * (stroke.painter->paint - ink);
  }
  return {static_cast<std::uint8_t>(ink[0]), static_cast<std::uint8_t>(ink[1]),
          static_cast<std::uint8_t>(ink[2])};
}

Bgr value_at(const cv::Mat& bgr, const vision::PixelPoint& place) {
  const int u = std::clamp(static_cast<int>(std::lround(place.x())), 0, bgr.cols - 1);
  const int v = std::clamp(static_cast<int>(std::lround(place.y())), 0, bgr.rows - 1);
  const auto& pixel = bgr.at<cv::Vec3b>(v, u);
  return {static_cast<float>(pixel[0]), static_cast<float>(pixel[1]), static_cast<float>(pixel[2])};
}

void draw_ring(cv::Mat& picture, const vision::DiscObservation& disc, const cv::Scalar& ink) {
  constexpr double kUnit = 1 << kDrawShift;
  const double radius_px = std::sqrt(disc.expected_pixels / std::numbers::pi) + 2.0;
  const cv::Point centre(static_cast<int>(std::lround(kUnit * disc.centre_px.x())),
                         static_cast<int>(std::lround(kUnit * disc.centre_px.y())));
  cv::circle(picture, centre, static_cast<int>(std::lround(kUnit * radius_px)), ink, 1, cv::LINE_AA,
             kDrawShift);
}

}  // namespace

std::vector<Colour> colours_of(const vision::MarkerLayout& layout) {
  std::vector<Colour> all;
  const auto add = [&all](Colour colour) {
    if (std::find(all.begin(), all.end(), colour) == all.end()) all.push_back(colour);
  };
  for (const vision::Team& team : layout.teams) add(team.centre_colour);
  if (layout.is_anonymous()) {
    for (const vision::Disc& disc : layout.outer) add(disc.colour);
  }
  for (const vision::Identity& identity : layout.identities) {
    for (const Colour colour : identity.outer_colours) add(colour);
  }
  return all;
}

Bgr mean_surroundings(const std::vector<ColourSample>& samples) {
  Bgr sum = Bgr::Zero();
  for (const ColourSample& sample : samples) sum += sample.surroundings;
  return samples.empty() ? sum : Bgr(sum / static_cast<float>(samples.size()));
}

cv::Mat classified_picture(const cv::Mat& bgr, const std::vector<Colour>& colours,
                           const vision::ColourClasses& classes, const Bgr& surroundings,
                           const vision::DetectionResult& seen) {
  const std::vector<Painter> all = painters(colours, classes);
  cv::Mat picture(bgr.size(), CV_8UC3);
  for (int v = 0; v < bgr.rows; ++v) {
    const auto* from = bgr.ptr<cv::Vec3b>(v);
    auto* to = picture.ptr<cv::Vec3b>(v);
    for (int u = 0; u < bgr.cols; ++u) {
      const Bgr value(from[u][0], from[u][1], from[u][2]);
      to[u] = painted(value, stroke_of(all, value - surroundings));
    }
  }
  const cv::Scalar right(255, 255, 255);
  const cv::Scalar wrong(60, 60, 255);
  for (const vision::RobotObservation& robot : seen.robots) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(robot.disc_count); ++i) {
      const vision::DiscObservation& disc = robot.discs[i];
      const Painter* painter = stroke_of(all, value_at(bgr, disc.centre_px) - surroundings).painter;
      const bool agrees = painter != nullptr && painter->colour == disc.colour;
      draw_ring(picture, disc, agrees || !has_hue(disc.colour) ? right : wrong);
    }
  }
  return picture;
}

}  // namespace nadir::calibration
