#pragma once

#include <Eigen/Core>
#include <vector>

#include "control_client/experiment/run_metrics.h"
#include "fusion/planar_pose.h"

namespace nadir::control_client {

/// Which frames an estimate may know.
enum class BoundKind {
  kDelayed,    ///< those that have arrived
  kZeroDelay,  ///< those that were captured, as if they came at once
  kSmoothing,  ///< all of the run, also the later ones
};

/// The posterior Cramer-Rao bound of the pose at the end of each tick of a run: no estimator that
/// knows just these frames has a smaller covariance (theory 3.4; Tichavsky, Muravchik, Nehorai,
/// IEEE Trans. Signal Processing 46, 1998). It holds where odometry errors are white with
/// covariance `rate_covariance` of a tick's mean rates. Lost frames and outliers carry no
/// information.
///
///     P- = A(truth) P A^T + W(truth) Q W^T,   P = ((P-)^-1 + [frame] Rk^-1)^-1
std::vector<fusion::PoseCovariance> cramer_rao_bound(const RunRecord& record,
                                                     const Eigen::Matrix3d& rate_covariance,
                                                     const fusion::PoseCovariance& start,
                                                     BoundKind kind);

/// Root mean square error that the bound allows, over the ticks later than `from_s`.
PoseErrors bound_errors(const RunRecord& record, const std::vector<fusion::PoseCovariance>& bound,
                        double from_s = 1.0);

}  // namespace nadir::control_client
