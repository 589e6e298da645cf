#pragma once

#include <array>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "vision/pixel.h"

namespace nadir::vision {

/// One tag as the image shows it.
struct TagObservation {
  int id = 0;
  int corrected_bits = 0;                     ///< 0 or 1
  PixelPoint centre_px = PixelPoint::Zero();  ///< image of the square's middle
  /// Of the black border, at (-1, 1), (1, 1), (1, -1), (-1, -1) of the tag's own frame: x to the
  /// right and y down of the printed tag, half its side as the unit.
  std::array<PixelPoint, 4> corners_px{};
  double decision_margin = 0.0;  ///< mean contrast of its bits, grey levels
};

/// Names that TagDetector knows: "tag36h11" and others.
const std::vector<std::string>& tag_families();

/// Finds square fiducial marks with libapriltag, whose pixel origin, memory and threads end here:
/// its (0.5, 0.5) is our (0, 0).
///
/// Centres are good to about 0.03 px for sides of 30 px and more, 0.1 px at 14 px; smaller than
/// 12 px is not found. Not thread-safe: one per thread.
class TagDetector {
 public:
  /// `decimate` 1 looks at every pixel; 2 is five times as fast and misses the smallest tags.
  /// Throws std::invalid_argument for a family that is not known.
  explicit TagDetector(const std::string& family = "tag36h11", double decimate = 1.0);
  ~TagDetector();
  TagDetector(TagDetector&&) noexcept;
  TagDetector& operator=(TagDetector&&) noexcept;

  /// `picture`: CV_8UC1 or CV_8UC3 (blue green red), at least 8 px on each side, else nothing is
  /// found. By rising id; one id may be there several times.
  std::vector<TagObservation> detect(const cv::Mat& picture);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nadir::vision
