#pragma once

#include <cstddef>
#include <vector>

#include "control_client/experiment/experiment.h"

namespace nadir::control_client {

/// Root mean square and largest error of a pose over time.
struct PoseErrors {
  double position_rms_m = 0.0;  ///< of the distance
  double heading_rms_rad = 0.0;
  double position_max_m = 0.0;
};

/// Errors of one estimator in one run.
struct EstimateMetrics {
  PoseErrors error;   ///< estimate minus truth
  double nees = 0.0;  ///< mean of d^T P^-1 d, expectation 3; 0 without a covariance
  double nis = 0.0;   ///< mean of the accepted frames, recovered ones left out
  int accepted = 0;   ///< frames, good and bad
  int outliers = 0;   ///< bad frames that came and are farther off than kOutlier_m
  int outliers_accepted = 0;
  int inliers = 0;  ///< good frames that came
  int inliers_rejected = 0;
};

/// Errors of one run.
struct RunMetrics {
  PoseErrors to_nominal;          ///< truth minus nominal motion
  PoseErrors to_command;          ///< truth minus commanded trajectory
  double path_rms_m = 0.0;        ///< distance to the commanded path, whenever it was due
  double to_nominal_max_m = 0.0;  ///< from the first tick on
  double overshoot_x_m = 0.0;     ///< largest x beyond the command's last one; of use for steps
  double settled_s = 0.0;         ///< last time farther than 2 cm or 2 deg from the command
  double saturated = 0.0;         ///< share of the ticks
  double peak_demand_v = 0.0;
  bool has_diverged = false;
  std::vector<EstimateMetrics> estimates;  ///< in the order of the estimators
};

/// Farther off than this a bad frame counts as an outlier.
inline constexpr double kOutlier_m = 0.020;

/// Measures what is later than `from_s`.
RunMetrics measure(const RunRecord& record, double from_s = 1.0);

/// Over runs: root mean square of the root mean squares, largest of the largest, latest of the
/// settling, means of the others, sums of the counts.
struct Summary {
  std::size_t runs = 0;
  int diverged = 0;
  RunMetrics mean;
};
Summary summarize(const std::vector<RunMetrics>& runs);

}  // namespace nadir::control_client
