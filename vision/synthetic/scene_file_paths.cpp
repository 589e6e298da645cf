#include "vision/synthetic/scene_file_paths.h"

#include <cmath>
#include <numbers>

namespace nadir::vision {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr ValidRange kLengths = {1e-3, 1e4};
constexpr ValidRange kSpeeds = {0.0, 100.0};

void read_line(const YamlMap& map, RobotPath& path) {
  path.corners_m = {path.centre_m, {map.number("to_x_m"), map.number("to_y_m")}};
  if (path.corners_m[0] == path.corners_m[1]) {
    throw map.error("to_x_m", "the line has no length", "move an end");
  }
}

void read_square(const YamlMap& map, RobotPath& path) {
  const double half_m = 0.5 * map.number("side_m", kLengths);
  for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
    path.corners_m.push_back(path.centre_m + half_m * Eigen::Vector2d(x, y));
  }
  path.closed = true;
}

void read_waypoints(const YamlMap& map, RobotPath& path) {
  const std::vector<double> x_m = map.numbers("x_m");
  const std::vector<double> y_m = map.numbers("y_m", x_m.size());
  if (x_m.size() < 2) throw map.error("x_m", "a path needs two waypoints", "add one");
  path.closed = map.boolean_or("closed", true);
  for (std::size_t i = 0; i < x_m.size(); ++i) path.corners_m.emplace_back(x_m[i], y_m[i]);
  for (std::size_t i = 0; i < x_m.size(); ++i) {
    const bool last = i + 1 == x_m.size();
    if ((!last || path.closed) && path.corners_m[i] == path.corners_m[last ? 0 : i + 1]) {
      throw map.error("x_m", "two neighbouring waypoints are equal", "remove one");
    }
  }
}

}  // namespace

RobotPath read_robot_path(const YamlMap& map) {
  RobotPath path;
  const std::string kind =
      map.choice_or("kind", "static", {"static", "line", "circle", "square", "waypoints"});
  path.heading_rad = kRadians * map.number_or("heading_deg", 0.0);
  if (kind != "waypoints") {
    path.centre_m = {map.number_or("x_m", 0.0), map.number_or("y_m", 0.0)};
  }
  if (kind == "circle") {
    path.kind = RobotPath::Kind::kCircle;
    path.radius_m = map.number("radius_m", kLengths);
    path.start_angle_rad = kRadians * map.number_or("start_deg", 0.0);
    path.speed_mps = map.number_or("speed_mps", 0.5, {-kSpeeds.high, kSpeeds.high});
  } else if (kind != "static") {
    path.kind = RobotPath::Kind::kPolyline;
    if (kind == "line") read_line(map, path);
    if (kind == "square") read_square(map, path);
    if (kind == "waypoints") read_waypoints(map, path);
    path.speed_mps = map.number_or("speed_mps", 0.5, kSpeeds);
    path.start_m = map.number_or("start_m", 0.0);
  }
  if (kind != "static") {
    path.faces_travel = map.choice_or("faces", "travel", {"travel", "fixed"}) == "travel";
  }
  if (!path.faces_travel) path.spin_radps = kRadians * map.number_or("spin_degps", 0.0);
  map.finish();
  return path;
}

}  // namespace nadir::vision
