#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "calibration/colours/colours_statistics.h"
#include "vision/marker_layout.h"
#include "vision/marker_observation.h"

namespace nadir::calibration {

/// The classes that a layout uses: those that the detector tells apart.
std::vector<vision::Colour> colours_of(const vision::MarkerLayout& layout);

/// The frame as the classes see it: every pixel whose hue against the robots' mean surroundings
/// belongs to one of `colours` is painted in that colour, the stronger the more it has of it; all
/// others are grey and dark. Discs of the robots found have a ring: white where the pixel in the
/// middle has the layout's colour, red where it has not.
///
/// `bgr`: CV_8UC3. Returns the same size and type.
cv::Mat classified_picture(const cv::Mat& bgr, const std::vector<vision::Colour>& colours,
                           const vision::ColourClasses& classes, const vision::Bgr& surroundings,
                           const vision::DetectionResult& seen);

/// Mean of what is around the discs.
vision::Bgr mean_surroundings(const std::vector<ColourSample>& samples);

}  // namespace nadir::calibration
