#include "fusion/gate.h"

#include <cmath>

namespace nadir::fusion {

bool Gate::passes(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& innovation_covariance,
                  double nis) const {
  switch (kind) {
    case Kind::kNone:
      return true;
    case Kind::kRectangular:
      for (int i = 0; i < 3; ++i) {
        const double limit = threshold * std::sqrt(innovation_covariance(i, i));
        if (!(std::abs(innovation[i]) <= limit)) return false;
      }
      return true;
    case Kind::kChiSquare:
      return nis <= threshold;
  }
  return false;
}

void extend(RejectedRun& run, const LockOutRecovery& recovery, const PlanarPose& pose,
            const Eigen::Vector3d& variance) {
  const Eigen::Vector3d difference = pose_difference(pose, run.pose);
  const std::array<double, 3> margin = {recovery.margin_m, recovery.margin_m, recovery.margin_rad};
  bool consistent = run.poses > 0;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double sigma = std::sqrt(run.variance.at(k) + variance[i]);
    consistent &= std::abs(difference[i]) <= recovery.sigmas * sigma + margin.at(k);
  }
  run.poses = consistent ? run.poses + 1 : 1;
  run.pose = pose;
  run.variance = {variance.x(), variance.y(), variance.z()};
}

}  // namespace nadir::fusion
