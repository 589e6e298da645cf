#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calibration/colours/colours_statistics.h"
#include "vision/colour_classes.h"
#include "vision/marker_layout.h"
#include "vision/marker_observation.h"
#include "vision/pixel_scale_grid.h"

namespace nadir::calibration {

/// Robots in frames whose light, and perhaps whose scale, is not known.
struct ColourSearchResult {
  vision::PixelScaleGrid scale;
  vision::ColourClasses classes;                ///< with which the robots were found
  std::vector<vision::DetectionResult> frames;  ///< one for each image
  std::vector<ColourSample> samples;            ///< all discs of all robots found
  int robots = 0;
  int robots_by_default = 0;  ///< found with the default colours at the same scale
};

/// Finds the robots of a layout in frames of one camera. Starts with the default colours; tries
/// them under warm, cold and green lights and keeps what finds most; then looks again with the
/// colours of the robots found, until no more are found.
///
/// `images`: CV_8UC3 of one size, at least one. `scale`: of the layout's marker plane; without it a
/// camera that looks straight down is assumed and its scale searched for, from discs of 3 px radius
/// up. Throws InputError where no robot is found, naming `files`.
ColourSearchResult search_colours(const std::vector<cv::Mat>& images,
                                  const vision::MarkerLayout& layout,
                                  const std::optional<vision::PixelScaleGrid>& scale,
                                  const std::string& files);

}  // namespace nadir::calibration
