#pragma once

#include <array>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "vision/pixel.h"
#include "vision/tag_family.h"

namespace nadir::vision {

/// One tag as the image shows it.
struct TagObservation {
  int family = 0;  ///< index into kTagFamilies
  int id = 0;
  int corrected_bits = 0;                     ///< 0 or 1, with a thorough reading up to 2
  PixelPoint centre_px = PixelPoint::Zero();  ///< image of the square's middle
  /// Of the square, at (-1, 1), (1, 1), (1, -1), (-1, -1) of the tag's own frame: x to the right
  /// and y down of the printed tag, half its side as the unit.
  std::array<PixelPoint, 4> corners_px{};
  double decision_margin = 0.0;  ///< mean distance of its bits from the threshold, grey levels
};

/// How much a detector believes.
enum class TagReading {
  kCareful,  ///< at most one wrong bit; edges fitted again to the picture's gradients
  /// Two wrong bits, edges as the segmentation has them: finds tags also where light, paper or
  /// focus spoil an edge or a bit, as in photographs by hand. Corners are coarser in good pictures.
  kThorough,
};

/// Area of the square, pixels.
double area_px2(const TagObservation& tag);

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
  /// Several families at once: indices into kTagFamilies.
  TagDetector(const std::vector<int>& families, double decimate,
              TagReading reading = TagReading::kCareful);
  ~TagDetector();
  TagDetector(TagDetector&&) noexcept;
  TagDetector& operator=(TagDetector&&) noexcept;

  /// As in the constructor.
  void set_decimation(double decimate);
  /// Least difference of black and white, grey levels, 1 to 200; 5 at first. The most of the time
  /// goes into edges that are weaker than those of the tags.
  void set_least_contrast(int grey_levels);

  /// `picture`: CV_8UC1 or CV_8UC3 (blue green red), at least 8 px on each side, else nothing is
  /// found. By rising id; one id may be there several times.
  std::vector<TagObservation> detect(const cv::Mat& picture);

  /// Looks at a part of the picture only; places are those of the whole picture. Appends, in no
  /// order. Only the part is turned grey, in memory that is kept.
  void detect_in(const cv::Mat& picture, const cv::Rect& part, std::vector<TagObservation>& tags);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nadir::vision
