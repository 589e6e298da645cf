#include "tests/bench/blob_pipeline.h"

#include <algorithm>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <set>
#include <stdexcept>

namespace nadir::bench {
namespace {

using vision::Colour;

// Thresholds made by hand for the synthetic camera's even light, as one makes them for a hall.
void hsv_range(Colour colour, cv::Scalar& lowest, cv::Scalar& highest) {
  switch (colour) {
    case Colour::kBlue:
      lowest = {95, 110, 70};
      highest = {125, 255, 255};
      return;
    case Colour::kYellow:
      lowest = {20, 110, 120};
      highest = {35, 255, 255};
      return;
    case Colour::kPink:
      lowest = {140, 70, 110};
      highest = {179, 255, 255};
      return;
    case Colour::kGreen:
      lowest = {40, 70, 130};
      highest = {85, 255, 255};
      return;
    default:
      throw std::invalid_argument("no HSV thresholds for this colour");
  }
}

}  // namespace

BlobPipeline::BlobPipeline(const vision::MarkerLayout& layout, double pixels_per_metre)
    : outer_count_(layout.outer.size()), reach_px_(0.0) {
  for (const vision::Team& team : layout.teams) {
    add_class(team.centre_colour, layout.centre_radius_m * pixels_per_metre, true);
  }
  std::set<Colour> outer_colours;
  if (layout.is_anonymous()) {
    for (const vision::Disc& disc : layout.outer) outer_colours.insert(disc.colour);
  }
  for (const vision::Identity& identity : layout.identities) {
    outer_colours.insert(identity.outer_colours.begin(), identity.outer_colours.end());
  }
  for (const Colour colour : outer_colours) {
    add_class(colour, layout.outer.front().radius_m * pixels_per_metre, false);
  }
  for (const vision::Disc& disc : layout.outer) {
    reach_px_ = std::max(reach_px_, 1.2 * disc.position_robot_m.norm() * pixels_per_metre);
  }
}

void BlobPipeline::add_class(Colour colour, double radius_px, bool is_centre) {
  ColourClass colour_class{colour, {}, {}, 0.0, 0.0, is_centre};
  hsv_range(colour, colour_class.lowest_hsv, colour_class.highest_hsv);
  const double area_px = std::numbers::pi * radius_px * radius_px;
  colour_class.least_area_px = 0.4 * area_px;
  colour_class.most_area_px = 2.0 * area_px;
  classes_.push_back(colour_class);
}

int BlobPipeline::count_robots(const cv::Mat& bgr) {
  cv::cvtColor(bgr, hsv_, cv::COLOR_BGR2HSV);
  blobs_.clear();
  for (const ColourClass& colour_class : classes_) find_blobs(colour_class);
  return group();
}

void BlobPipeline::find_blobs(const ColourClass& colour_class) {
  cv::inRange(hsv_, colour_class.lowest_hsv, colour_class.highest_hsv, mask_);
  const int count = cv::connectedComponentsWithStats(mask_, labels_, statistics_, centroids_, 8);
  for (int i = 1; i < count; ++i) {
    const int area_px = statistics_.at<int>(i, cv::CC_STAT_AREA);
    if (area_px < colour_class.least_area_px || area_px > colour_class.most_area_px) continue;
    blobs_.push_back(
        {{centroids_.at<double>(i, 0), centroids_.at<double>(i, 1)}, colour_class.is_centre});
  }
}

int BlobPipeline::group() const {
  int robots = 0;
  for (const Blob& centre : blobs_) {
    if (!centre.is_centre) continue;
    std::size_t near = 0;
    for (const Blob& outer : blobs_) {
      if (outer.is_centre) continue;
      near += cv::norm(outer.centre_px - centre.centre_px) <= reach_px_ ? 1 : 0;
    }
    robots += near >= outer_count_ ? 1 : 0;
  }
  return robots;
}

}  // namespace nadir::bench
