#include "tracker/pose_from_markers.h"

#include <algorithm>
#include <span>

#include "tracker/pixel_near.h"
#include "tracker/rigid_fit.h"

namespace nadir::tracker {

MarkerPose pose_from_markers(const vision::RobotObservation& observation,
                             const vision::MarkerLayout& layout, const calibration::PlaneMap& map,
                             const DiscCovariances& covariances_m2) {
  std::array<PlaneMarker, vision::kMaxDiscs> markers;
  const auto count = static_cast<std::size_t>(observation.disc_count);
  for (std::size_t i = 0; i < count; ++i) {
    markers[i].position_world_m = map.plane_from_pixel(observation.discs[i].centre_px);
    markers[i].covariance_m2 = covariances_m2[i];
    // Disc 0 is the centre disc, at the robot's origin.
    if (i > 0) markers[i].position_robot_m = layout.outer[i - 1].position_robot_m;
  }
  const RigidFit fit = fit_rigid_pose(std::span(markers.data(), count));

  MarkerPose result;
  result.pose_world_robot = fit.pose_world_robot;
  result.chi_square_per_dof = fit.chi_square / fit.degrees_of_freedom;
  result.covariance = fit.covariance * std::max(1.0, result.chi_square_per_dof);
  result.centre_px =
      pixel_near(map, fit.pose_world_robot.position_m(), observation.discs[0].centre_px);
  result.covariance.topLeftCorner<2, 2>() += map.calibration_covariance_m2(result.centre_px);
  return result;
}

}  // namespace nadir::tracker
