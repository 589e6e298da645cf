#include "fusion/slam/range_bearing.h"

#include <algorithm>
#include <cmath>

#include "fusion/sine_cosine.h"

namespace nadir::fusion {

PredictedSighting predicted_sighting(const PlanarPose& pose, const Eigen::Vector2d& landmark_m) {
  constexpr double kNearest_m = 1e-3;
  const Eigen::Vector2d d = landmark_m - pose.position_m();
  const double r = std::max(std::sqrt(d.squaredNorm()), kNearest_m);
  const double q = r * r;
  PredictedSighting predicted;
  predicted.seen = {r, wrap_angle(std::atan2(d.y(), d.x()) - pose.heading_rad)};
  predicted.by_landmark << d.x() / r, d.y() / r, -d.y() / q, d.x() / q;
  predicted.by_pose << -predicted.by_landmark, Eigen::Vector2d(0.0, -1.0);
  return predicted;
}

PlacedLandmark placed_landmark(const PlanarPose& pose, const RangeBearing& seen) {
  const SineCosine a = sine_cosine(wrap_angle(pose.heading_rad + seen.bearing_rad));
  const Eigen::Vector2d direction(a.cosine, a.sine);
  const Eigen::Vector2d aside(-a.sine, a.cosine);
  PlacedLandmark placed;
  placed.place_m = pose.position_m() + seen.range_m * direction;
  placed.by_pose << Eigen::Matrix2d::Identity(), seen.range_m * aside;
  placed.by_sighting << direction, seen.range_m * aside;
  return placed;
}

}  // namespace nadir::fusion
