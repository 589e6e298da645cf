#pragma once

#include <Eigen/Core>
#include <array>

#include "calibration/plane_map.h"
#include "fusion/planar_pose.h"
#include "vision/marker_layout.h"
#include "vision/marker_observation.h"

namespace nadir::tracker {

/// Covariance of each disc's place on the plane, m^2, in the order of RobotObservation::discs,
/// without the calibration's own part.
using DiscCovariances = std::array<Eigen::Matrix2d, vision::kMaxDiscs>;

/// A robot's pose as one frame shows it.
struct MarkerPose {
  fusion::PlanarPose pose_world_robot;
  fusion::PoseCovariance covariance = fusion::PoseCovariance::Zero();
  vision::PixelPoint centre_px = vision::PixelPoint::Zero();  ///< image of the robot's origin
  double chi_square_per_dof = 0.0;  ///< of the discs' residuals, before the covariance was inflated
};

/// Pose of a robot of `layout` from its discs (2 or more), which `map` brings to the plane. The
/// heading is measured in the world plane, so a calibration that mirrors the image (v down, y up)
/// is as good as any.
///
/// The covariance has three parts:
///  - the discs' own errors, independent of each other, through the least-squares fit;
///  - inflation by chi^2 per degree of freedom where the residuals are larger than those errors
///    explain (Birge's ratio): something disturbed the discs that the variances do not know of.
///    Small residuals never deflate it;
///  - the calibration's error. It varies over the field and not over one robot: all discs are
///    shifted together, more discs do not average it down, and the heading does not feel it. So it
///    is added to the x, y block at the end.
MarkerPose pose_from_markers(const vision::RobotObservation& observation,
                             const vision::MarkerLayout& layout, const calibration::PlaneMap& map,
                             const DiscCovariances& covariances_m2);

}  // namespace nadir::tracker
