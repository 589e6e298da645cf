#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "calibration/calibration_file.h"
#include "calibration/pixel_count_variance.h"
#include "tracker/pose_report.h"
#include "vision/synthetic/renderer.h"

namespace nadir::support {

/// One robot of the truth and the report that was matched to it.
struct PoseError {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  ///< reported minus true image of the origin
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  ///< reported minus true x, y (m), heading (rad)
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< as published
  std::vector<int> pixels;                               ///< seen of each marker

  /// Squared Mahalanobis distance of the error; 3 on average if the covariance holds.
  double nees() const;
};

/// What the whole way from a rendered frame to reported poses is worth in one scene.
struct AccuracyStudy {
  std::uint64_t robots = 0;  ///< in the truth
  std::uint64_t missed = 0;
  std::uint64_t wrong_names = 0;   ///< found at the right place under another id or team
  std::uint64_t false_robots = 0;  ///< reported where there is none
  std::vector<PoseError> errors;   ///< of those that were found and named rightly

  double found_share() const;
  Eigen::Vector2d centre_rms_px() const;
  Eigen::Vector2d centre_bias_px() const;
  double heading_rms_deg() const;
  double mean_nees() const;
};

/// Points of the scene's marker plane, fitted by polynomial2 as nadir-calibrate would.
calibration::Calibration calibrate_from_scene(const vision::Scene& scene, std::uint64_t seed);

/// Renders `frames` frames of the scene, runs nadir-tracker's pipeline over them and compares with
/// the truth.
AccuracyStudy study_accuracy(const vision::Scene& scene, std::uint64_t seed, int frames,
                             const calibration::PixelCountVariance& variance = {});

}  // namespace nadir::support
