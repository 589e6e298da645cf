#include "vision/tag_search.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace nadir::vision {
namespace {

constexpr int kBands = 5;  // a newcomer is seen within so many frames
// Of the tags' own contrast: edges that are weaker are none of theirs.
constexpr double kLeastShare = 0.3;
constexpr double kLeastShareOfStrongest = 0.25;  // while no tag is known
constexpr int kWeakestContrast = 20;             // grey levels; weaker tags are not found
constexpr double kForget = 0.02;  // a frame: what was learnt gives way to weaker tags' contrast
// Of a mark's half side, in any direction: half diagonal of the print with its margin.
constexpr double kReach = 0.95;
constexpr double kSizeTolerance = 0.25;
constexpr double kSizeTolerance_px = 1.5;

// Decimation that still finds all tags of that size.
double decimation_for(double side_px) {
  return side_px >= 28.0 ? 2.0 : side_px >= 20.0 ? 1.5 : 1.0;
}

std::vector<int> families_of(const std::vector<TagKind>& kinds) {
  std::vector<int> families;
  for (const TagKind& kind : kinds) {
    if (std::ranges::find(families, kind.layout.family) == families.end()) {
      families.push_back(kind.layout.family);
    }
  }
  return families;
}

double smallest_side_px(const std::vector<TagKind>& kinds) {
  double side_px = INFINITY;
  for (const TagKind& kind : kinds) {
    side_px = std::min(side_px, kind.layout.size_m * kind.scale.smallest_pixels_per_metre());
  }
  return side_px;
}

double largest_side_px(const std::vector<TagKind>& kinds) {
  double side_px = 0.0;
  for (const TagKind& kind : kinds) {
    side_px = std::max(side_px, kind.layout.size_m * kind.scale.largest_pixels_per_metre());
  }
  return side_px;
}

// A square that the border cuts may be read all the same, but its corners are wrong then.
bool is_whole(const TagObservation& tag, const cv::Rect& part) {
  constexpr double kBorder_px = 4.0;
  return std::ranges::all_of(tag.corners_px, [&part](const PixelPoint& corner) {
    return corner.x() >= part.x + kBorder_px && corner.y() >= part.y + kBorder_px &&
           corner.x() <= part.br().x - 1 - kBorder_px && corner.y() <= part.br().y - 1 - kBorder_px;
  });
}

bool holds_one(const cv::Rect& box, const TagSearchResult& result) {
  return std::ranges::any_of(result.tags, [&box](const TagSighting& tag) {
    return box.contains(cv::Point(static_cast<int>(std::lround(tag.tag.centre_px.x())),
                                  static_cast<int>(std::lround(tag.tag.centre_px.y()))));
  });
}

}  // namespace

cv::Rect tag_box(const PixelPoint& centre_px, double side_px, double margin_px) {
  const double reach_px = kReach * side_px + margin_px + 2.0;
  const cv::Point low(static_cast<int>(std::floor(centre_px.x() - reach_px)),
                      static_cast<int>(std::floor(centre_px.y() - reach_px)));
  const int size = static_cast<int>(std::ceil(2.0 * reach_px)) + 1;
  return {low.x, low.y, size, size};
}

TagSearch::TagSearch(std::vector<TagKind> kinds)
    : kinds_(std::move(kinds)),
      smallest_side_px_(vision::smallest_side_px(kinds_)),
      largest_side_px_(vision::largest_side_px(kinds_)),
      detector_(families_of(kinds_), 1.0),
      contrast_(kinds_.front().scale.width_px(), kinds_.front().scale.height_px(),
                std::clamp(static_cast<int>(smallest_side_px_ / 6.0), 1, 8)) {}

void TagSearch::search(const cv::Mat& image, std::span<const ExpectedTag> expected,
                       std::span<const cv::Rect> found, bool everywhere, TagSearchResult& result) {
  result.tags.clear();
  result.rejected.clear();
  for (const ExpectedTag& tag : expected) {
    const cv::Rect box = tag_box(tag.centre_px, tag.side_px, tag.margin_px);
    look_around(image, box, tag.side_px, result);
    everywhere = everywhere || !holds_one(box, result);
  }
  const bool nobody = expected.empty() && found.empty();
  search_newcomers(image, found, everywhere || nobody, result);
  if (found.empty() || !result.tags.empty()) learn_contrast(result);
}

void TagSearch::look_around(const cv::Mat& image, const cv::Rect& part, double side_px,
                            TagSearchResult& result) {
  seen_.clear();
  detector_.set_decimation(decimation_for(side_px));
  detector_.set_least_contrast(std::max(least_contrast_, 5));
  detector_.detect_in(image, part, seen_);
  const cv::Rect inside = part & cv::Rect(0, 0, image.cols, image.rows);
  for (const TagObservation& tag : seen_) {
    if (is_whole(tag, inside)) {
      judge(tag, result);
    } else if (!is_whole(tag, {0, 0, image.cols, image.rows})) {
      reject(tag, RejectReason::kOutsideImage, result);
    }
  }
}

void TagSearch::search_newcomers(const cv::Mat& image, std::span<const cv::Rect> found,
                                 bool everywhere, TagSearchResult& result) {
  // Bands overlap by a tag, so that none is cut by every band that it lies in.
  const int tile = contrast_.tile_px();
  const int overlap = static_cast<int>(std::ceil(2.0 * kReach * largest_side_px_ / tile));
  const int first = everywhere ? 0 : contrast_.rows() * next_band_ / kBands;
  const int last =
      everywhere ? contrast_.rows() + 1 : contrast_.rows() * (next_band_ + 1) / kBands + overlap;
  next_band_ = (next_band_ + 1) % kBands;
  contrast_.look(image, first, last);
  const bool known = least_contrast_ > 0;
  const int strongest = known ? 0 : contrast_.strongest();
  for (const cv::Rect& part : found) contrast_.blank(part);
  for (const TagSighting& tag : result.tags) {
    contrast_.blank(tag_box(tag.tag.centre_px, tag.side_px, 0.0));
  }
  if (!known) {
    least_contrast_ =
        std::max(kWeakestContrast, static_cast<int>(kLeastShareOfStrongest * strongest));
  }
  const int reach = static_cast<int>(std::ceil(largest_side_px_ / 2.0)) + 4;
  for (const cv::Rect& patch : contrast_.patches(least_contrast_)) {
    look_around(
        image,
        {patch.x - reach, patch.y - reach, patch.width + 2 * reach, patch.height + 2 * reach},
        smallest_side_px_, result);
  }
  if (!known) least_contrast_ = 0;
}

void TagSearch::reject(const TagObservation& tag, RejectReason reason, TagSearchResult& result) {
  const double reach_px = 0.5 * std::sqrt(area_px2(tag));
  const auto told = [&](const RejectedCandidate& other) {
    return (other.centre_px - tag.centre_px).norm() < reach_px;
  };
  if (std::ranges::none_of(result.rejected, told)) {
    result.rejected.push_back({tag.centre_px, reason});
  }
}

// Into the result: as a robot's tag, or with what speaks against it. Parts of the image overlap, so
// a tag may come twice.
void TagSearch::judge(const TagObservation& tag, TagSearchResult& result) const {
  const double side_px = std::sqrt(area_px2(tag));
  const auto same = [&](const TagSighting& other) {
    return other.tag.family == tag.family && other.tag.id == tag.id &&
           (other.tag.centre_px - tag.centre_px).norm() < 0.5 * side_px;
  };
  if (std::ranges::any_of(result.tags, same)) return;
  RejectReason reason = RejectReason::kUnknownTag;
  for (std::size_t i = 0; i < kinds_.size(); ++i) {
    const TagKind& kind = kinds_[i];
    if (kind.layout.family != tag.family || !kind.layout.find(tag.id)) continue;
    const Eigen::Matrix2d scale = kind.scale.pixels_per_metre(tag.centre_px);
    const double expected_px = kind.layout.size_m * std::sqrt(std::abs(scale.determinant()));
    if (std::abs(side_px - expected_px) > kSizeTolerance * expected_px + kSizeTolerance_px) {
      reason = RejectReason::kWrongTagSize;
      continue;
    }
    result.tags.push_back({i, tag, side_px, 2.0 * tag.decision_margin});
    return;
  }
  reject(tag, reason, result);
}

void TagSearch::learn_contrast(const TagSearchResult& result) {
  if (result.tags.empty()) {
    if (least_contrast_ > 0) {  // perhaps it got dark: in a second or two nothing is known any more
      least_contrast_ -= std::max(1, static_cast<int>(kForget * least_contrast_));
      if (least_contrast_ < kWeakestContrast) least_contrast_ = 0;
    }
    return;
  }
  double weakest = INFINITY;
  for (const TagSighting& tag : result.tags) weakest = std::min(weakest, tag.contrast);
  // The weakest of the tags counts; stronger ones raise it slowly.
  const double now = std::max<double>(kWeakestContrast, kLeastShare * weakest);
  const double before = least_contrast_ > 0 ? least_contrast_ : now;
  least_contrast_ = static_cast<int>(now < before ? now : before + 0.1 * (now - before));
}

}  // namespace nadir::vision
