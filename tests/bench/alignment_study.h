#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "tracker/alignment/mosaic.h"
#include "tracker/alignment/pose_aligner.h"
#include "vision/synthetic/scene.h"

namespace nadir::bench {

/// A scene and what is done to it.
struct AlignmentCase {
  std::string name;
  std::string scene;  ///< of data/scenes
  tracker::Mosaic mosaic = tracker::Mosaic::kNone;
  double speed_mps = 0.0;  ///< of every robot, in any direction
  double exposure_s = 0.0;
  double gamma = 1.0;
  double light = 1.0;    ///< times the scene's own
  int jpeg_quality = 0;  ///< 0: none
};

/// The cases of the room's README.
std::vector<AlignmentCase> alignment_cases();

/// What aligning robots near their true poses is worth in one case, with an exact calibration.
struct AlignmentStudy {
  std::uint64_t robots = 0;
  std::uint64_t lost = 0;
  double position_rms_px = 0.0;  ///< per axis
  double heading_rms_deg = 0.0;
  Eigen::Vector2d bias_px = Eigen::Vector2d::Zero();
  double nees = 0.0;
  double worst_nees = 0.0;
  double position_bound_px = 0.0;  ///< Cramer-Rao, RMS of some robots
  double heading_bound_deg = 0.0;
  double position_median_ratio = 0.0;  ///< median error over that of the bound, robot by robot
  double heading_median_ratio = 0.0;
  double iterations = 0.0;
  double microseconds = 0.0;  ///< of one robot, median
  double blur_px = 0.0;       ///< learnt
  double read = 0.0;
  double shot = 0.0;
  std::uint64_t overconfident = 0;  ///< errors beyond 6 sigma of any of the three

  double position_ratio() const { return position_rms_px / position_bound_px; }
  double heading_ratio() const { return heading_rms_deg / heading_bound_deg; }
};

/// Guesses start `guess_px` RMS per axis away from the truth.
AlignmentStudy study_alignment(const AlignmentCase& which, int frames, double guess_px,
                               const tracker::AlignmentSettings& settings = {});

}  // namespace nadir::bench
