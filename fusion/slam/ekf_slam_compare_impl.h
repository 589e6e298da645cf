#pragma once

// The functions of EkfSlam that compare a sighting with a landmark; included by its header alone.

#include <Eigen/LU>

#include "fusion/slam/ekf_slam.h"

namespace nadir::fusion {

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
int EkfSlam<OdometryError, SensorError>::index_of(int name) const {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (names_[i] == name) return static_cast<int>(i);
  }
  return -1;
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
auto EkfSlam<OdometryError, SensorError>::compare(const Sighting& sighting, int landmark) const
    -> Comparison {
  // v = c(z, e) - h(x, l);  with errors "true minus estimated":
  //     v = h_x dx + h_l dl - c_e de + c_z white
  const Eigen::Matrix<double, kSensorStates, 1> error = sensor_error();
  const auto corrected = settings_.sensor_error.corrected(sighting.measured, error);
  const PredictedSighting predicted = predicted_sighting(pose_, landmark_m(landmark));
  Comparison result;
  result.innovation = sighting_difference(corrected.seen, predicted.seen);
  result.by_head.template leftCols<3>() = predicted.by_pose;
  if constexpr (kSensorStates > 0) {
    result.by_head.template rightCols<kSensorStates>() = -corrected.by_error;
  }
  result.by_landmark = predicted.by_landmark;
  result.noise = corrected.by_measured * sighting.covariance * corrected.by_measured.transpose();
  return result;
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
Eigen::Matrix2d EkfSlam<OdometryError, SensorError>::innovation_covariance(const Comparison& a,
                                                                           int landmark_a,
                                                                           const Comparison& b,
                                                                           int landmark_b) const {
  // Ha P Hb^T over the head's and the landmarks' blocks, without noise.
  const Eigen::Matrix<double, 2, kSeen> a_head =
      a.by_head * covariance_.head_block().template topLeftCorner<kSeen, kSeen>() +
      a.by_landmark * covariance_.landmark_head(landmark_a).template leftCols<kSeen>();
  const Eigen::Matrix2d a_landmark =
      a.by_head * covariance_.landmark_head(landmark_b).template leftCols<kSeen>().transpose() +
      a.by_landmark * covariance_.between(landmark_a, landmark_b);
  return a_head * b.by_head.transpose() + a_landmark * b.by_landmark.transpose();
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
double EkfSlam<OdometryError, SensorError>::nis(const Comparison& comparison, int landmark) const {
  const Eigen::Matrix2d s =
      innovation_covariance(comparison, landmark, comparison, landmark) + comparison.noise;
  return comparison.innovation.dot(s.inverse() * comparison.innovation);
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
bool EkfSlam<OdometryError, SensorError>::refuse(const Sighting& sighting, std::size_t index,
                                                 SightingReport& report) const {
  report = SightingReport{};
  const bool is_good = sighting.measured.vector().allFinite() && sighting.measured.range_m > 0.0 &&
                       sighting.covariance.allFinite() && sighting.covariance.determinant() > 0.0;
  if (is_good && index >= kMaxSightings) report.verdict = SightingVerdict::kNoRoom;
  return !is_good || index >= kMaxSightings;
}

}  // namespace nadir::fusion
