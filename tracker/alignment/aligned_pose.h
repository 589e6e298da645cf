#pragma once

#include <Eigen/Core>
#include <array>

#include "calibration/noise_file.h"
#include "fusion/planar_pose.h"
#include "vision/marker_layout.h"
#include "vision/pixel.h"

namespace nadir::tracker {

/// A value of each channel, blue green red, grey levels.
using ChannelVector = Eigen::Vector3d;

/// One disc after its robot's pose was aligned.
struct AlignedDisc {
  ChannelVector level = ChannelVector::Zero();     ///< of the plate beside it
  ChannelVector contrast = ChannelVector::Zero();  ///< of the disc, against the plate
  vision::PixelPoint centre_px = vision::PixelPoint::Zero();
  double pixels = 0.0;              ///< of the image that show it, in shares
  double chi_square_per_dof = 0.0;  ///< of its pixels' residuals
  bool counts = false;              ///< took part: it is in the image and not covered
};

/// A robot's pose, estimated from the pixels themselves.
struct AlignedPose {
  fusion::PlanarPose pose_world_robot;
  /// Inverse of the Fisher information, inflated where residuals are larger than noise, and a
  /// floor. Without the calibration's part.
  fusion::PoseCovariance covariance = fusion::PoseCovariance::Zero();
  vision::PixelPoint centre_px = vision::PixelPoint::Zero();  ///< image of the robot's origin
  std::array<AlignedDisc, vision::kMaxDiscs> discs;
  int counting_discs = 0;
  int iterations = 0;
  bool uneven_light = false;  ///< on a disc that counts: a shadow's edge
  double misfit = 0.0;  ///< chi-square per degree of freedom of the discs against the rigid pattern
};

/// What a robot is expected to look like when it is followed: contrasts of its discs as they were.
struct ExpectedLook {
  std::array<ChannelVector, vision::kMaxDiscs> contrast;
};

/// A guess of a pose, good to about a disc's radius and 20 degrees.
struct PoseGuess {
  fusion::PlanarPose pose_world_robot;
  vision::PixelPoint centre_px = vision::PixelPoint::Zero();  ///< roughly where the image shows it
};

/// Settings that are the same for every camera and every light.
struct AlignmentSettings {
  double huber_sigmas = 2.5;
  double far_sigmas = 5.0;  ///< a pixel's pull fades beyond it, once the pose is nearly right
  /// Error of a disc's centre, per axis, that neither noise nor residuals tell of.
  double floor_px = calibration::kAlignmentFloor_px;
  double rim_sigmas = 2.2;  ///< pixels nearer to the plate's rim than this many blurs are masked
  /// Pixels further from a disc's edge than this many blurs say nothing of where it is.
  double margin_sigmas = 2.0;
  double least_cosine = 0.97;  ///< between the expected and the seen contrast of a disc
  /// Of a disc's contrast over the expected one, to the median disc.
  double least_amplitude = 0.45;
};

}  // namespace nadir::tracker
