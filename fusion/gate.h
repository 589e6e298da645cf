#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "fusion/planar_pose.h"

namespace nadir::fusion {

/// Which innovations are believed.
struct Gate {
  enum class Kind : std::uint8_t {
    kNone,         ///< all
    kRectangular,  ///< |e_i| <= threshold sqrt(S_ii) in each of x, y, heading (S0 eq 16)
    kChiSquare     ///< e^T S^-1 e <= threshold
  };
  Kind kind = Kind::kChiSquare;
  double threshold = 14.156;

  static Gate none() { return {Kind::kNone, 0.0}; }
  /// The papers' gate: rejects 0.81 % of good poses where the components are independent.
  static Gate rectangular(double sigmas = 3.0) { return {Kind::kRectangular, sigmas}; }
  /// 14.156 rejects 0.27 % of good poses (3 degrees of freedom), 11.345 one percent.
  static Gate chi_square(double threshold = 14.156) { return {Kind::kChiSquare, threshold}; }

  /// `innovation` with its covariance S and `nis` = e^T S^-1 e.
  bool passes(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& innovation_covariance,
              double nis) const;
};

/// When poses beyond the gate are believed after all (theory 3.1): a filter that lost its way while
/// its covariance stayed small rejects the truth for seconds. A rejected pose is consistent with
/// the rejected one before it, moved on by odometry, if in each of x, y, heading they differ by at
/// most sigmas sqrt(sum of their variances) + margin. After `poses` consistent ones in a row,
/// without an accepted one among them, the last is believed.
struct LockOutRecovery {
  int poses = 5;  ///< 0: never believed
  double sigmas = 4.0;
  double margin_m = 0.004;
  double margin_rad = 0.020;
  /// Farther than this the robot was carried there: the filter starts anew instead of inflating
  /// its covariance.
  double far_m = 0.3;
  double far_rad = 0.8;
};

/// The rejected poses in a row that say the same: part of the recorded state, as replay has to
/// decide as the first pass did.
struct RejectedRun {
  int poses = 0;
  PlanarPose pose;  ///< the last of them, moved on by odometry
  std::array<double, 3> variance = {};
};

/// Counts one more rejected pose with the diagonal of its covariance.
void extend(RejectedRun& run, const LockOutRecovery& recovery, const PlanarPose& pose,
            const Eigen::Vector3d& variance);

}  // namespace nadir::fusion
