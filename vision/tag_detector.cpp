#include "vision/tag_detector.h"

#include <apriltag/apriltag.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "vision/libapriltag_family.h"

namespace nadir::vision {
namespace {

/// libapriltag calls the middle of the top-left pixel (0.5, 0.5).
constexpr double kPixelOrigin = 0.5;
constexpr int kSmallestSide_px = 8;  // it crashes below 6

/// In large pictures two bits make false tags, and need gigabytes of tables for the larger
/// families. In the smallest family one bit is too much already: every hundredth dark square would
/// be a tag.
int corrected_bits(int family, TagReading reading) {
  const int cells = kTagFamilies.at(static_cast<std::size_t>(family)).square_cells;
  if (cells == 6) return 0;
  return reading == TagReading::kThorough && cells == 8 ? 2 : 1;
}

std::vector<int> family_list(const std::string& name) {
  const auto family = find_tag_family(name);
  if (!family) throw std::invalid_argument("no tag family '" + name + "'");
  return {*family};
}

/// Luminance in one channel, with the weights of common video.
void turn_grey(const cv::Mat& bgr, cv::Mat& grey) {
  for (int v = 0; v < bgr.rows; ++v) {
    const auto* from = bgr.ptr<std::uint8_t>(v);
    auto* to = grey.ptr<std::uint8_t>(v);
    for (int u = 0; u < bgr.cols; ++u) {
      to[u] = static_cast<std::uint8_t>(
          (29 * from[3 * u] + 150 * from[3 * u + 1] + 77 * from[3 * u + 2] + 128) >> 8);
    }
  }
}

}  // namespace

double area_px2(const TagObservation& tag) {
  const PixelPoint a = tag.corners_px[2] - tag.corners_px[0];
  const PixelPoint b = tag.corners_px[3] - tag.corners_px[1];
  return 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
}

struct TagDetector::State {
  State(const std::vector<int>& family_indices, double decimate, TagReading reading)
      : detector(apriltag_detector_create(), apriltag_detector_destroy) {
    detector->nthreads = 1;  // one detector per thread instead
    detector->quad_decimate = static_cast<float>(decimate);
    detector->refine_edges = reading == TagReading::kCareful;
    for (const int family : family_indices) {
      families.push_back(library_family(family));
      indices.push_back(family);
      apriltag_detector_add_family_bits(detector.get(), families.back().get(),
                                        corrected_bits(family, reading));
    }
  }

  /// The part as libapriltag wants it: grey, without a copy where it is grey already.
  cv::Mat grey_of(const cv::Mat& part) {
    if (part.channels() == 1) return part;
    if (memory.rows < part.rows || memory.cols < part.cols) {
      memory.create(std::max(part.rows, memory.rows), std::max(part.cols, memory.cols), CV_8UC1);
    }
    cv::Mat grey = memory(cv::Rect(0, 0, part.cols, part.rows));
    turn_grey(part, grey);
    return grey;
  }

  TagObservation observation(const apriltag_detection_t& detection, const cv::Point& corner) const {
    const auto pixel = [&corner](const double(&place)[2]) {
      return PixelPoint(place[0] - kPixelOrigin + corner.x, place[1] - kPixelOrigin + corner.y);
    };
    TagObservation tag;
    for (std::size_t i = 0; i < families.size(); ++i) {
      if (families[i].get() == detection.family) tag.family = indices[i];
    }
    tag.id = detection.id;
    tag.corrected_bits = detection.hamming;
    tag.decision_margin = static_cast<double>(detection.decision_margin);
    tag.centre_px = pixel(detection.c);
    for (std::size_t i = 0; i < tag.corners_px.size(); ++i) {
      tag.corners_px[i] = pixel(detection.p[i]);
    }
    return tag;
  }

  std::vector<int> indices;
  std::vector<LibraryFamily> families;  // must live longer than the detector: destroyed after it
  std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)> detector;
  cv::Mat memory;
};

TagDetector::TagDetector(const std::string& family, double decimate)
    : TagDetector(family_list(family), decimate) {}
TagDetector::TagDetector(const std::vector<int>& families, double decimate, TagReading reading)
    : state_(std::make_unique<State>(families, decimate, reading)) {}
TagDetector::~TagDetector() = default;
TagDetector::TagDetector(TagDetector&&) noexcept = default;
TagDetector& TagDetector::operator=(TagDetector&&) noexcept = default;

void TagDetector::set_decimation(double decimate) {
  state_->detector->quad_decimate = static_cast<float>(decimate);
}

void TagDetector::set_least_contrast(int grey_levels) {
  state_->detector->qtp.min_white_black_diff = std::clamp(grey_levels, 1, 200);
}

std::vector<TagObservation> TagDetector::detect(const cv::Mat& picture) {
  std::vector<TagObservation> tags;
  detect_in(picture, {0, 0, picture.cols, picture.rows}, tags);
  std::stable_sort(tags.begin(), tags.end(),
                   [](const auto& a, const auto& b) { return a.id < b.id; });
  return tags;
}

void TagDetector::detect_in(const cv::Mat& picture, const cv::Rect& part,
                            std::vector<TagObservation>& tags) {
  const cv::Rect inside = part & cv::Rect(0, 0, picture.cols, picture.rows);
  if (inside.width < kSmallestSide_px || inside.height < kSmallestSide_px) return;
  cv::Mat grey = state_->grey_of(picture(inside));
  image_u8_t view{grey.cols, grey.rows, static_cast<std::int32_t>(grey.step), grey.data};
  zarray_t* found = apriltag_detector_detect(state_->detector.get(), &view);
  for (int i = 0; i < zarray_size(found); ++i) {
    apriltag_detection_t* detection = nullptr;
    zarray_get(found, i, static_cast<void*>(&detection));
    tags.push_back(state_->observation(*detection, inside.tl()));
  }
  apriltag_detections_destroy(found);
}

}  // namespace nadir::vision
