#pragma once

#include <opencv2/core.hpp>
#include <span>

#include "calibration/plane_map.h"
#include "tracker/pose_report.h"
#include "vision/marker_layout.h"

namespace nadir::bench {

/// Differences between frame and template are drawn so many times as large as they are.
inline constexpr double kResidualGain = 4.0;

struct ResidualPicture {
  cv::Mat bgr;             ///< CV_8UC3
  double left_grey = 0.0;  ///< RMS of the differences, all robots and channels, grey levels
  double marks_grey =
      0.0;               ///< RMS contrast of the discs against the plate: what there was to explain
  double blur_px = 0.0;  ///< of the camera, as learnt from these robots
  double noise_grey = 0.0;  ///< of its pixels at the plates' level, as learnt
};

/// What the template explains of a frame (CV_8UC3) and what it leaves, a column for each robot: the
/// frame, the template with the levels that its alignment found, and their difference (grey: none).
ResidualPicture residual_picture(const cv::Mat& bgr, const calibration::PlaneMap& map,
                                 const vision::MarkerLayout& layout,
                                 std::span<const tracker::RobotReport> robots);

}  // namespace nadir::bench
