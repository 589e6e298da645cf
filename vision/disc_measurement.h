#pragma once

#include <opencv2/core.hpp>

#include "vision/colour_classes.h"
#include "vision/local_scale.h"
#include "vision/pixel.h"

namespace nadir::vision {

/// One disc measured in the image.
struct DiscMeasurement {
  PixelPoint centre_px = PixelPoint::Zero();
  double pixels = 0.0;             ///< sum of the pixels' shares in the disc
  double expected_pixels = 0.0;    ///< area by the calibration
  double variance_px2 = 0.0;       ///< of the centre, per axis
  double contrast = 0.0;           ///< length of colour - surroundings, grey levels
  Bgr colour = Bgr::Zero();        ///< of the disc's middle
  Bgr surroundings = Bgr::Zero();  ///< of most of a ring around the disc
};

enum class MeasureOutcome { kMeasured, kOutsideImage, kWeakContrast, kDriftsAway };

/// Finds the centre of the disc of radius `radius_m` near `start` (at most one radius away). Every
/// pixel's share in the disc is its value projected on the line from the surroundings' colour to
/// the disc's, or on a line turned from it so that a second colour of the surroundings counts
/// nothing; the centre is the mean of the pixels weighted with a share that is limited above, so
/// that a shadow across the disc hardly moves it. `plate`: the colour under the robot's other
/// discs, where it is known; among several colours around the disc it is the one that counts.
///
/// The variance follows from the scatter of the surroundings and of the disc's inside, carried to
/// the centre through the pixels that are not limited (those on the edge); from the slope of the
/// light across the disc; and from the pixel grid itself: `sampling_variance_px2` / sqrt(N) for N
/// pixels seen, more for discs that are hardly larger than their edge.
MeasureOutcome measure_disc(const cv::Mat& bgr, const LocalScale& scale, double radius_m,
                            const PixelPoint& start, double sampling_variance_px2,
                            DiscMeasurement& disc, const Bgr* plate = nullptr);

/// What the pixel grid leaves of a centre's error in a frame without noise, per axis: this much
/// / sqrt(N) (1 + (24 / N)^2), measured with the synthetic camera on discs of 12 to 530 pixels,
/// point spread 0.7 px.
inline constexpr double kSamplingVariance_px2 = 0.0011;
/// The same where two of three colours of every pixel are interpolated from a Bayer mosaic.
inline constexpr double kDemosaicedSamplingVariance_px2 = 0.0031;

}  // namespace nadir::vision
