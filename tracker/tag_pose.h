#pragma once

#include <Eigen/Core>
#include <span>

#include "calibration/plane_map.h"
#include "fusion/planar_pose.h"
#include "tracker/pose_from_markers.h"
#include "vision/tag_detector.h"
#include "vision/tag_layout.h"

namespace nadir::tracker {

/// Where one tag lies on the plane, and where on its robot.
struct TagPose {
  fusion::PlanarPose pose_world_tag;  ///< the tag's middle and its x axis
  fusion::PoseCovariance covariance =
      fusion::PoseCovariance::Zero();  ///< without the calibration's part
  /// Largest distance of a corner from the square of the layout's size, share of its side.
  double misshape = 0.0;
  vision::PixelPoint centre_px = vision::PixelPoint::Zero();
  vision::TagMount mount;
};

/// Standard deviation of a detected tag's middle, per axis, px, and of its heading, rad.
struct TagDeviation {
  double centre_px = 0.0;
  double heading_rad = 0.0;
};

/// What libapriltag is good for: an error of its line fits that does not depend on noise, larger
/// for small tags, and one that noise brings (`contrast`: white minus black, grey levels;
/// tracker/README.md has the measurements that this law was fitted to). `side_px` 10 or more.
TagDeviation tag_deviation(double side_px, double contrast);

/// The tag on the plane of `map`, which must be that of the tag's height: its corners go through
/// the map, their mean is its middle, and its heading is the mean of all four sides'. A pose in
/// space from the four corners, as is usual, is ambiguous just for cameras that look straight down.
TagPose tag_pose(const vision::TagObservation& tag, double size_m, const vision::TagMount& mount,
                 const calibration::PlaneMap& map);

/// The robot's pose from one or more of its tags: least squares with the tags' covariances,
/// inflated where they disagree by more than that; then the calibration's error, which all of them
/// share.
MarkerPose pose_from_tags(std::span<const TagPose> tags, const calibration::PlaneMap& map);

}  // namespace nadir::tracker
