#pragma once

// The function of EkfSlam that takes a measured pose; included by its header alone.

#include <cmath>

#include "fusion/measured_pose.h"
#include "fusion/sine_cosine.h"
#include "fusion/slam/ekf_slam.h"

namespace nadir::fusion {

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
Correction EkfSlam<OdometryError, SensorError>::correct(const PlanarPose& measured,
                                                        const PoseCovariance& covariance) {
  Correction correction;
  if (const auto reason = reason_to_refuse(measured, covariance)) {
    correction.verdict = *reason;
    return correction;
  }
  covariance_.catch_up();
  const PoseCovariance r = symmetric_part(covariance);
  correction.compare(measured, r, pose_, pose_covariance());
  correction.verdict = settings_.pose_gate.passes(correction.innovation,
                                                  correction.innovation_covariance, correction.nis)
                           ? PoseVerdict::kAccepted
                           : PoseVerdict::kGated;
  if (correction.verdict == PoseVerdict::kGated) return correction;
  covariance_.panel(3) = covariance_.head_columns().template leftCols<3>();
  innovation_covariance_.template topLeftCorner<3, 3>() = correction.innovation_covariance;
  innovation_.template head<3>() = correction.innovation;
  if (settings_.error == ErrorKind::kInvariant) {
    // So that turn_positions leads to the measured place: dp = xi + J p t, z = Rot(t) p + V(t) xi.
    const double t = correction.innovation.z();
    const SineCosine rotation = sine_cosine(t);
    const double half = 0.5 * t;
    const double a =
        std::abs(t) < 1e-4 ? 1.0 - t * t / 12.0 : half * (1.0 + rotation.cosine) / rotation.sine;
    const Eigen::Vector2d p = pose_.position_m();
    const Eigen::Vector2d left(measured.x_m - rotation.cosine * p.x() + rotation.sine * p.y(),
                               measured.y_m - rotation.sine * p.x() - rotation.cosine * p.y());
    // V(t)^-1 = [ a, t/2 ; -t/2, a ],  a = (t/2) cot(t/2)
    innovation_[0] = a * left.x() + half * left.y() - p.y() * t;
    innovation_[1] = -half * left.x() + a * left.y() + p.x() * t;
  }
  apply(3);
  return correction;
}

}  // namespace nadir::fusion
