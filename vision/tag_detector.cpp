#include "vision/tag_detector.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagStandard41h12.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>

namespace nadir::vision {
namespace {

/// libapriltag calls the middle of the top-left pixel (0.5, 0.5).
constexpr double kPixelOrigin = 0.5;
constexpr int kSmallestSide_px = 8;  // it crashes below 6
/// Two bits make false tags in large pictures, and gigabytes of tables for the larger families.
constexpr int kCorrectedBits = 1;

struct Family {
  const char* name;
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

constexpr std::array<Family, 4> kFamilies = {{
    {"tag36h11", tag36h11_create, tag36h11_destroy},
    {"tag25h9", tag25h9_create, tag25h9_destroy},
    {"tag16h5", tag16h5_create, tag16h5_destroy},
    {"tagStandard41h12", tagStandard41h12_create, tagStandard41h12_destroy},
}};

const Family& family_of(const std::string& name) {
  const auto found = std::find_if(kFamilies.begin(), kFamilies.end(),
                                  [&](const Family& each) { return name == each.name; });
  if (found == kFamilies.end()) throw std::invalid_argument("no tag family '" + name + "'");
  return *found;
}

PixelPoint pixel(const double (&place)[2]) {
  return {place[0] - kPixelOrigin, place[1] - kPixelOrigin};
}

TagObservation observation(const apriltag_detection_t& detection) {
  TagObservation tag;
  tag.id = detection.id;
  tag.corrected_bits = detection.hamming;
  tag.decision_margin = static_cast<double>(detection.decision_margin);
  tag.centre_px = pixel(detection.c);
  for (std::size_t i = 0; i < tag.corners_px.size(); ++i) {
    tag.corners_px[i] = pixel(detection.p[i]);
  }
  return tag;
}

/// Luminance in one channel, with the weights of common video.
cv::Mat grey_of(const cv::Mat& bgr) {
  cv::Mat grey(bgr.size(), CV_8UC1);
  for (int v = 0; v < bgr.rows; ++v) {
    const auto* from = bgr.ptr<cv::Vec3b>(v);
    auto* to = grey.ptr<std::uint8_t>(v);
    for (int u = 0; u < bgr.cols; ++u) {
      to[u] =
          static_cast<std::uint8_t>((29 * from[u][0] + 150 * from[u][1] + 77 * from[u][2]) >> 8);
    }
  }
  return grey;
}

}  // namespace

const std::vector<std::string>& tag_families() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    all.reserve(kFamilies.size());
    for (const Family& each : kFamilies) all.emplace_back(each.name);
    return all;
  }();
  return names;
}

struct TagDetector::State {
  State(const Family& of_family, double decimate)
      : family(of_family), codes(family.create()), detector(apriltag_detector_create()) {
    detector->nthreads = 1;  // one detector per thread instead
    detector->quad_decimate = static_cast<float>(decimate);
    apriltag_detector_add_family_bits(detector, codes, kCorrectedBits);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {  // in this order
    apriltag_detector_destroy(detector);
    family.destroy(codes);
  }

  const Family& family;
  apriltag_family_t* codes;
  apriltag_detector_t* detector;
};

TagDetector::TagDetector(const std::string& family, double decimate)
    : state_(std::make_unique<State>(family_of(family), decimate)) {}
TagDetector::~TagDetector() = default;
TagDetector::TagDetector(TagDetector&&) noexcept = default;
TagDetector& TagDetector::operator=(TagDetector&&) noexcept = default;

std::vector<TagObservation> TagDetector::detect(const cv::Mat& picture) {
  std::vector<TagObservation> tags;
  if (picture.cols < kSmallestSide_px || picture.rows < kSmallestSide_px) return tags;
  cv::Mat grey = picture.channels() == 3 ? grey_of(picture) : picture;
  image_u8_t view{grey.cols, grey.rows, static_cast<std::int32_t>(grey.step), grey.data};
  zarray_t* found = apriltag_detector_detect(state_->detector, &view);
  for (int i = 0; i < zarray_size(found); ++i) {
    apriltag_detection_t* detection = nullptr;
    zarray_get(found, i, static_cast<void*>(&detection));
    tags.push_back(observation(*detection));
  }
  apriltag_detections_destroy(found);
  std::stable_sort(tags.begin(), tags.end(),
                   [](const auto& a, const auto& b) { return a.id < b.id; });
  return tags;
}

}  // namespace nadir::vision
