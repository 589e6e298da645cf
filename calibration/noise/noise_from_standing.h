#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "calibration/noise/noise_from_log.h"

namespace nadir::calibration {

/// One robot while it stood at one place.
struct StandingSpan {
  std::string file;
  std::string robot;
  int samples = 0;
  /// Of x m, y m, heading rad about their means, samples - 1 degrees of freedom.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::vector<double> pixels;  ///< mean of each marker
  /// Variance per axis of the point of the robot that its heading's noise does not move (the
  /// weighted middle of its markers), 2 (samples - 1) degrees of freedom.
  double middle_variance_m2 = 0.0;
  Eigen::Vector2d middle_variance_axes_m2 = Eigen::Vector2d::Zero();  ///< the same, x and y apart
  /// The same per axis as it was published, a mean.
  double published_middle_variance_m2 = 0.0;
  Eigen::Matrix2d jacobian_m_per_px = Eigen::Matrix2d::Zero();  ///< of the calibration there
  double aligned_share = 0.0;  ///< of the samples: poses by alignment, not of detected marks
};

/// What recordings hold of robots that stand.
struct StandingData {
  std::vector<StandingSpan> spans;
  int samples = 0;         ///< of all robots
  int moving_samples = 0;  ///< left out: the robot moved, was knocked, or was seen too briefly
  double rate_hz = 0.0;    ///< mean rate of a robot's samples; 0 where there are not two
};

/// Samples of one window; a span has two of them at least.
inline constexpr int kStandingWindow = 20;

/// Finds where robots stand. A window of kStandingWindow samples stands if
///
///     successive differences scatter like independent noise:   sum d^2 / sum (x - mean)^2
///         has mean 2 and variance 4 (n - 2)/(n^2 - 1) then (von Neumann, Annals of Mathematical
///         Statistics 12, 1941); motion makes it small,
///     and no sample lies far outside (a knock, a misread marker),
///
/// in x, y and heading. Neighbouring windows of equal mean are one span; a window without such a
/// neighbour creeps, and is left out.
///
/// The middle of the markers is found from the covariance that was published with each pose: a
/// heading error e moves the robot's origin by lever * e with lever = cov(xy, heading) /
/// var(heading), whatever law the variances came from.
StandingData find_standing(const std::vector<LoggedTrack>& tracks);

}  // namespace nadir::calibration
