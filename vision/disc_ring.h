#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "vision/colour_classes.h"
#include "vision/local_scale.h"
#include "vision/pixel.h"

namespace nadir::vision {

inline constexpr int kRingSamples = 16;

/// Pixels on a circle of the plane, in sixteen directions: one row for each channel.
using Ring = std::array<std::array<std::uint8_t, kRingSamples>, 3>;

/// The pixels nearest to the circle of radius `radius_px` (in units of the local scale) about
/// `centre`; places outside the image take its border.
void sample_ring(const cv::Mat& bgr, const LocalScale& scale, const PixelPoint& centre,
                 float radius_px, Ring& ring);

/// The ring that shows what is around a disc of this radius: just beyond its blurred edge.
void sample_surroundings(const cv::Mat& bgr, const LocalScale& scale, const PixelPoint& centre,
                         float disc_radius_px, Ring& ring);

/// Median of each channel: up to seven of sixteen pixels may show something else.
Bgr median_of_ring(const Ring& ring);

/// Mean colour of a disc's middle: the centre and eight pixels half a radius from it.
Bgr middle_colour(const cv::Mat& bgr, const LocalScale& scale, const PixelPoint& centre,
                  float radius_px);

/// Difference of the middle of a disc of radius `radius_m` at `centre` from what is around it.
/// Tells cheaply what is not worth measuring.
Bgr glance_at_disc(const cv::Mat& bgr, const LocalScale& scale, double radius_m,
                   const PixelPoint& centre);

}  // namespace nadir::vision
