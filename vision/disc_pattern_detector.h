#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <span>

#include "vision/colour_classes.h"
#include "vision/marker_layout.h"
#include "vision/marker_observation.h"
#include "vision/pixel_scale_grid.h"
#include "vision/sparse_search.h"

namespace nadir::vision {

/// A part of the picture to be searched, less what is known to be there.
struct SearchArea {
  std::span<const RowBand> bands{};     ///< of the picture's rows, in any order
  std::span<const PixelPoint> known{};  ///< robots' origins: nothing is looked for on them
};

/// Finds all robots of one layout in a frame without knowing anything of earlier frames.
/// Looks at a sparse grid of pixels first, then closely where a centre disc may be. Not
/// thread-safe: one per thread.
class DiscPatternDetector {
 public:
  /// `scale` must be that of the layout's marker plane. Throws InputError if the discs would be too
  /// small to see.
  DiscPatternDetector(const MarkerLayout& layout, const PixelScaleGrid& scale,
                      const ColourClasses& colours = default_colour_classes());
  ~DiscPatternDetector();
  DiscPatternDetector(DiscPatternDetector&&) noexcept;
  DiscPatternDetector& operator=(DiscPatternDetector&&) noexcept;

  /// `bgr` is CV_8UC3 of the scale grid's size. `result` is cleared and filled; no memory is
  /// allocated after the first call. An identity may be found twice: the tracker decides. Throws
  /// std::invalid_argument for a frame of another type or size.
  void detect(const cv::Mat& bgr, DetectionResult& result);
  /// The same with robots only whose centre disc lies in the area.
  void detect(const cv::Mat& bgr, const SearchArea& area, DetectionResult& result);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nadir::vision
