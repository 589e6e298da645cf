#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "control_client/differential/differential_run.h"

namespace nadir::control_client {

/// One row of an experiment's table.
struct DifferentialCase {
  std::string name;
  std::string label;  ///< for people
  DifferentialScenario scenario;
  double corner_m = 0.0;  ///< half side of a square around the origin; 0: the path is none
};

/// S1's two L shapes with a kick (E8), two circles (E9) and weights on a square (E10); theory 9
/// and 12.8.
std::vector<DifferentialCase> l_shape_cases();
std::vector<DifferentialCase> two_circle_cases();
std::vector<DifferentialCase> square_cases();

/// Means over the runs; rms: root of the mean square over runs and ticks.
struct DifferentialSummary {
  int runs = 0;
  double position_rms_m = 0.0;   ///< truth to reference
  double position_max_m = 0.0;   ///< largest, mean over the runs
  double position_end_m = 0.0;   ///< mean over the runs
  double side_end_m = 0.0;       ///< |e2| at the end, mean over the runs
  double heading_rms_rad = 0.0;  ///< estimate to truth
  double overshoot_m = 0.0;      ///< beyond the corners of the square, mean over the runs
  double settled_s = 0.0;        ///< after the kick until it stays within 50 mm, mean over the runs
};

struct DifferentialResult {
  DifferentialCase which;
  DifferentialSummary summary;
  std::vector<DifferentialTick> example;  ///< the first run
};

DifferentialResult run_case(const DifferentialCase& which, std::uint64_t first_seed, int runs);

}  // namespace nadir::control_client
