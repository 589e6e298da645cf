#pragma once

#include <utility>
#include <vector>

#include "control_client/rover/rover_run.h"

namespace nadir::control_client {

/// What runs of one variant have in common. Errors are estimate minus truth, at every tick; indices
/// as in S4 (sums over samples, without dt): means over the runs, roots of mean squares where they
/// are called rms. Of runs that did not diverge.
struct RoverSummary {
  int runs = 0;
  int diverged = 0;
  double diverged_s = 0.0;  ///< mean over those
  double iae_xy_m = 0.0;    ///< sum of |ex| + |ey|
  double mae_xy_m = 0.0;    ///< largest |ex| + |ey|
  double iae_heading_rad = 0.0;
  double mae_heading_rad = 0.0;
  double position_rms_m = 0.0;
  double heading_rms_rad = 0.0;
  double heading_deviation_rad = 0.0;  ///< largest |true heading|: it is to be kept at 0
  double landmark_rms_m = 0.0;         ///< at the end, in the world frame
  int tours_done = 0;
  double tour_done_s = 0.0;  ///< mean over those
  double nees = 0.0;  ///< of the pose, mean over runs and ticks after the first; expectation 3
  double nees_in_band = 0.0;  ///< share of ticks with the runs' mean in its 95 % band
  double nis = 0.0;           ///< of the sightings; expectation 2
};

RoverSummary summarize(const RoverWorld& world, const std::vector<RoverRecord>& records);

/// Band of 95 % of the mean over `runs` of a chi-square number with 3 degrees of freedom (Wilson
/// and Hilferty's approximation: [2.03, 4.16] for 20 runs).
std::pair<double, double> nees_band(int runs);

}  // namespace nadir::control_client
