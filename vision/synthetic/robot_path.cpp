#include "vision/synthetic/robot_path.h"

#include <cmath>
#include <numbers>

namespace nadir::vision {
namespace {

constexpr double kCornerReachM = 0.05;
constexpr double kDifferenceStepS = 1e-3;

double wrapped(double angle_rad) {
  const double angle = std::remainder(angle_rad, 2.0 * std::numbers::pi);
  return angle <= -std::numbers::pi ? std::numbers::pi : angle;
}

/// The place after `way_m` along the corners; closed paths go round, open ones to and fro.
Eigen::Vector2d on_polyline(const RobotPath& path, double way_m) {
  const std::size_t corners = path.corners_m.size();
  const std::size_t sides = path.closed ? corners : corners - 1;
  double length_m = 0.0;
  for (std::size_t i = 0; i < sides; ++i) {
    length_m += (path.corners_m[(i + 1) % corners] - path.corners_m[i]).norm();
  }
  const double period_m = path.closed ? length_m : 2.0 * length_m;
  double rest_m = way_m - period_m * std::floor(way_m / period_m);
  if (rest_m > length_m) rest_m = period_m - rest_m;
  for (std::size_t i = 0; i < sides; ++i) {
    const Eigen::Vector2d side = path.corners_m[(i + 1) % corners] - path.corners_m[i];
    const double side_m = side.norm();
    if (rest_m <= side_m || i + 1 == sides) return path.corners_m[i] + side * (rest_m / side_m);
    rest_m -= side_m;
  }
  return path.corners_m.back();
}

/// A closed path is looked along from 5 cm behind to 5 cm ahead; on an open one the robot drives
/// backwards back.
double direction_on_polyline(const RobotPath& path, double way_m) {
  Eigen::Vector2d chord;
  if (path.closed) {
    chord = on_polyline(path, way_m + kCornerReachM) - on_polyline(path, way_m - kCornerReachM);
  } else {
    chord = path.corners_m.back() - path.corners_m.front();
  }
  return std::atan2(chord.y(), chord.x());
}

struct PlaceAndHeading {
  Eigen::Vector2d place_m;
  double heading_rad;
};

PlaceAndHeading place_and_heading(const RobotPath& path, double time_s) {
  const double own_heading_rad =
      path.heading_rad + (path.faces_travel ? 0.0 : path.spin_radps * time_s);
  if (path.kind == RobotPath::Kind::kStatic) return {path.centre_m, own_heading_rad};
  if (path.kind == RobotPath::Kind::kPolyline) {
    const double way_m = path.start_m + path.speed_mps * time_s;
    const double travel_rad = path.faces_travel ? direction_on_polyline(path, way_m) : 0.0;
    return {on_polyline(path, way_m), own_heading_rad + travel_rad};
  }
  const double angle_rad = path.start_angle_rad + path.speed_mps / path.radius_m * time_s;
  const Eigen::Vector2d radius(std::cos(angle_rad), std::sin(angle_rad));
  const double quarter_rad = std::copysign(std::numbers::pi / 2.0, path.speed_mps);
  const double travel_rad = path.faces_travel ? angle_rad + quarter_rad : 0.0;
  return {path.centre_m + path.radius_m * radius, own_heading_rad + travel_rad};
}

}  // namespace

RobotMotion RobotPath::at(double time_s) const {
  const PlaceAndHeading now = place_and_heading(*this, time_s);
  const PlaceAndHeading before = place_and_heading(*this, time_s - 0.5 * kDifferenceStepS);
  const PlaceAndHeading after = place_and_heading(*this, time_s + 0.5 * kDifferenceStepS);
  const Eigen::Vector2d velocity = (after.place_m - before.place_m) / kDifferenceStepS;
  const double turn_rad = wrapped(after.heading_rad - before.heading_rad);
  return {now.place_m.x(), now.place_m.y(), wrapped(now.heading_rad),
          velocity.x(),    velocity.y(),    turn_rad / kDifferenceStepS};
}

}  // namespace nadir::vision
