#pragma once

// The functions of EkfSlam: start and motion, and the others' files; included by its header alone.

#include "fusion/odometry.h"
#include "fusion/slam/ekf_slam.h"

namespace nadir::fusion {

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
EkfSlam<OdometryError, SensorError>::EkfSlam(const Settings& settings)
    : settings_(settings), covariance_(kHead, settings.most_landmarks, 2 * kMaxSightings) {
  const Eigen::Index n = kHead + 2 * settings.most_landmarks;
  error_.setZero();
  places_m_ = Eigen::VectorXd::Zero(2 * settings.most_landmarks);
  names_.reserve(static_cast<std::size_t>(settings.most_landmarks));
  innovation_covariance_ = Eigen::MatrixXd::Zero(2 * kMaxSightings, 2 * kMaxSightings);
  innovation_ = Eigen::VectorXd::Zero(2 * kMaxSightings);
  change_ = Eigen::VectorXd::Zero(n);
  lean_ = Eigen::VectorXd::Zero(n);
  start({}, PoseCovariance::Zero());
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
void EkfSlam<OdometryError, SensorError>::start(const PlanarPose& pose,
                                                const PoseCovariance& covariance) {
  pose_ = {pose.x_m, pose.y_m, wrap_angle(pose.heading_rad)};
  error_.setZero();
  names_.clear();
  lost_scans_ = 0;
  recoveries_ = 0;
  HeadMatrix head = HeadMatrix::Zero();
  head.template topLeftCorner<3, 3>() = covariance;
  if constexpr (kSensorStates > 0) {
    head.template block<kSensorStates, kSensorStates>(3, 3) =
        settings_.sensor_error.initial_covariance();
  }
  if constexpr (kOdometryStates > 0) {
    head.template bottomRightCorner<kOdometryStates, kOdometryStates>() =
        settings_.odometry_error.initial_covariance();
  }
  covariance_.restart(head);
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
void EkfSlam<OdometryError, SensorError>::predict(const OdometryStep& step) {
  // As PoseFilter::predict; the sensor's errors are states of the head too:
  //     F = [ A  0   W J ]   A = by_pose, W = by_rates, J = d rates / d e
  //         [ 0  Fs  0   ]
  //         [ 0  0   Fo  ]   noise = [ W (intensity / dt) W^T ; Qs ; Qo ]
  const Eigen::Matrix<double, kOdometryStates, 1> odometry = odometry_error();
  const auto corrected = settings_.odometry_error.corrected(step, odometry);
  const Motion motion = constant_rate_motion(pose_.heading_rad, corrected.rates, step.dt_s);
  HeadMatrix f = HeadMatrix::Identity();
  HeadMatrix noise = HeadMatrix::Zero();
  f.template topLeftCorner<3, 3>() = motion.by_pose();
  noise.template topLeftCorner<3, 3>() =
      motion.by_rates * (corrected.white_intensity / step.dt_s) * motion.by_rates.transpose();
  if constexpr (kSensorStates > 0) {
    const auto sensor = settings_.sensor_error.transition(step.dt_s);
    f.template block<kSensorStates, kSensorStates>(3, 3) = sensor.transition;
    noise.template block<kSensorStates, kSensorStates>(3, 3) = sensor.noise_covariance;
    error_.template head<kSensorStates>() =
        (sensor.transition * error_.template head<kSensorStates>()).eval();
  }
  if constexpr (kOdometryStates > 0) {
    const auto error = settings_.odometry_error.transition(step);
    f.template topRightCorner<3, kOdometryStates>() = motion.by_rates * corrected.by_error;
    f.template bottomRightCorner<kOdometryStates, kOdometryStates>() = error.transition;
    noise.template bottomRightCorner<kOdometryStates, kOdometryStates>() = error.noise_covariance;
    error_.template tail<kOdometryStates>() = (error.transition * odometry).eval();
  }
  covariance_.predict(f, noise);
  pose_ = moved(pose_, motion);
}

template <OdometryErrorModel OdometryError, SensorErrorModel SensorError>
void EkfSlam<OdometryError, SensorError>::move(const Eigen::Vector3d& displacement,
                                               const Eigen::Matrix3d& covariance) {
  // The displacement does not depend on the heading's error: F = I.
  HeadMatrix noise = HeadMatrix::Zero();
  noise.template topLeftCorner<3, 3>() = covariance;
  covariance_.predict(HeadMatrix::Identity(), noise);
  pose_ = {pose_.x_m + displacement.x(), pose_.y_m + displacement.y(),
           wrap_angle(pose_.heading_rad + displacement.z())};
}

}  // namespace nadir::fusion

#include "fusion/slam/ekf_slam_compare_impl.h"
#include "fusion/slam/ekf_slam_named_impl.h"
#include "fusion/slam/ekf_slam_nameless_impl.h"
#include "fusion/slam/ekf_slam_pose_impl.h"
#include "fusion/slam/ekf_slam_update_impl.h"
