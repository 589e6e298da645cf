#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "vision/contrast_map.h"
#include "vision/marker_observation.h"
#include "vision/pixel_scale_grid.h"
#include "vision/tag_detector.h"
#include "vision/tag_layout.h"

namespace nadir::vision {

/// One layout's tags, and how large they are in the image.
struct TagKind {
  TagLayout layout;
  PixelScaleGrid scale;  ///< of the plane of the tags
};

/// A place where a tag is looked for because it was followed to there.
struct ExpectedTag {
  PixelPoint centre_px = PixelPoint::Zero();
  double side_px = 0.0;    ///< of its square
  double margin_px = 0.0;  ///< how far it may be from there
};

/// A tag that a robot of a layout carries.
struct TagSighting {
  std::size_t kind = 0;  ///< index into the search's kinds
  TagObservation tag;
  double side_px = 0.0;   ///< square root of its square's area
  double contrast = 0.0;  ///< white minus black, grey levels, about
};

/// What one frame shows. The vectors keep their memory.
struct TagSearchResult {
  std::vector<TagSighting> tags;
  std::vector<RejectedCandidate> rejected;
};

/// Finds the tags of a frame without reading all of it: around the places where they are expected,
/// and elsewhere where there is contrast at all. A fifth of the frame is looked at for newcomers in
/// each frame; the whole frame while nobody is followed, and where a tag is not where it is
/// expected.
///
/// How much contrast counts is learnt from the tags that are seen; before the first one it is a
/// quarter of the strongest that the frame has. It is forgotten where no tag is seen any more. A
/// tag counts if a layout has its number and it is as large as the calibration says. Not
/// thread-safe.
class TagSearch {
 public:
  /// `kinds`: at least one. All grids of one size, that of the frames.
  explicit TagSearch(std::vector<TagKind> kinds);

  /// `image`: CV_8UC3 or CV_8UC1. `found`: parts of the image whose tags are known already, not
  /// searched for newcomers. `everywhere`: search the whole frame now.
  void search(const cv::Mat& image, std::span<const ExpectedTag> expected,
              std::span<const cv::Rect> found, bool everywhere, TagSearchResult& result);

  const std::vector<TagKind>& kinds() const { return kinds_; }
  /// Least contrast of an edge that is looked at, grey levels.
  int least_contrast() const { return least_contrast_; }

 private:
  void look_around(const cv::Mat& image, const cv::Rect& part, double side_px,
                   TagSearchResult& result);
  void search_newcomers(const cv::Mat& image, std::span<const cv::Rect> found, bool everywhere,
                        TagSearchResult& result);
  static void reject(const TagObservation& tag, RejectReason reason, TagSearchResult& result);
  void judge(const TagObservation& tag, TagSearchResult& result) const;
  void learn_contrast(const TagSearchResult& result);

  std::vector<TagKind> kinds_;
  double smallest_side_px_;
  double largest_side_px_;
  TagDetector detector_;
  ContrastMap contrast_;
  int least_contrast_ = 0;  // 0: nothing is known
  int next_band_ = 0;
  std::vector<TagObservation> seen_;
};

/// A box that holds a tag of this size in every direction, with its margin.
cv::Rect tag_box(const PixelPoint& centre_px, double side_px, double margin_px);

}  // namespace nadir::vision
