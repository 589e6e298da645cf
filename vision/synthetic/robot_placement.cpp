#include "vision/synthetic/robot_placement.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "vision/synthetic/random_stream.h"

namespace nadir::vision {
namespace {

constexpr std::uint64_t kRobotPurpose = 1;
constexpr std::uint64_t kClutterPurpose = 2;
constexpr int kTriesPerRobot = 500;
constexpr int kTriesPerGroup = 20;

/// True if a circle on the plane is in the image with `margin_px` to spare.
bool circle_in_image(const CameraModel& camera, const Eigen::Vector2d& place_m, double height_m,
                     double radius_m, double margin_px) {
  for (int i = 0; i < 16; ++i) {
    const double angle = i * std::numbers::pi / 8.0;
    const Eigen::Vector3d rim(place_m.x() + radius_m * std::cos(angle),
                              place_m.y() + radius_m * std::sin(angle), height_m);
    if (!camera.sees(camera.project(rim), margin_px)) return false;
  }
  return true;
}

Eigen::Vector2d random_place(const CameraModel& camera, double height_m, RandomStream& random) {
  const double u_px = random.uniform(0.0, camera.width_px() - 1.0);
  const double v_px = random.uniform(0.0, camera.height_px() - 1.0);
  return camera.on_plane({u_px, v_px}, height_m);
}

bool clear_of(const std::vector<RobotPlacement>& robots, const Eigen::Vector2d& place_m,
              double distance_m) {
  for (const RobotPlacement& robot : robots) {
    if (std::hypot(robot.motion.x_m - place_m.x(), robot.motion.y_m - place_m.y()) < distance_m) {
      return false;
    }
  }
  return true;
}

/// The next of the (team, id) pairs that nobody has yet, in random order.
class NameDraw {
 public:
  NameDraw(const MarkerLayout& layout, const RandomRobots& wish) {
    for (const std::size_t team : wish.teams) {
      if (layout.is_anonymous()) {
        for (int id = 0; id < wish.count; ++id) names_.push_back({team, id});
      } else {
        for (const int id : layout.robot_ids()) names_.push_back({team, id});
      }
    }
  }
  std::pair<std::size_t, int> draw(RandomStream& random) {
    if (names_.empty()) throw std::invalid_argument("more random robots than teams and identities");
    const std::size_t chosen = random.below(names_.size());
    const std::pair<std::size_t, int> name = names_[chosen];
    names_.erase(names_.begin() + static_cast<std::ptrdiff_t>(chosen));
    return name;
  }

 private:
  std::vector<std::pair<std::size_t, int>> names_;
};

/// Adds the robots one by one; false if one of them finds no room.
bool add_random_robots(const Scene& scene, const CameraModel& camera, const RandomRobots& wish,
                       RandomStream& random, std::vector<RobotPlacement>& robots) {
  const MarkerLayout& layout = scene.layouts.at(wish.layout);
  NameDraw names(layout, wish);
  for (int i = 0; i < wish.count; ++i) {
    RobotPlacement robot;
    robot.layout = wish.layout;
    std::tie(robot.team, robot.id) = names.draw(random);
    robot.motion.heading_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
    bool placed = false;
    for (int attempt = 0; attempt < kTriesPerRobot && !placed; ++attempt) {
      const Eigen::Vector2d place_m = random_place(camera, layout.height_m, random);
      placed = circle_in_image(camera, place_m, layout.height_m,
                               scene.bodies.at(wish.layout).radius_m, wish.border_margin_px) &&
               clear_of(robots, place_m, wish.minimum_distance_m);
      robot.motion.x_m = place_m.x();
      robot.motion.y_m = place_m.y();
    }
    if (!placed) return false;
    robots.push_back(robot);
  }
  return true;
}

/// An unlucky start can leave no room for the last robot: then all of them are drawn again.
void add_random_group(const Scene& scene, const CameraModel& camera, const RandomRobots& wish,
                      RandomStream& random, std::vector<RobotPlacement>& robots) {
  const std::size_t before = robots.size();
  for (int attempt = 0; attempt < kTriesPerGroup; ++attempt) {
    if (add_random_robots(scene, camera, wish, random, robots)) return;
    robots.resize(before);
  }
  throw std::invalid_argument("the image has no room for that many random robots");
}

}  // namespace

std::vector<RobotPlacement> placements_in_frame(const Scene& scene, const CameraModel& camera,
                                                std::uint64_t seed, std::uint64_t frame_number) {
  std::vector<RobotPlacement> robots;
  const double time_s = static_cast<double>(frame_number) / scene.rate_hz;
  for (const SceneRobot& robot : scene.robots) {
    robots.push_back({robot.layout, robot.team, robot.id, robot.path.at(time_s)});
  }
  for (std::size_t i = 0; i < scene.random_robots.size(); ++i) {
    const RandomRobots& wish = scene.random_robots[i];
    RandomStream random(seed + i, wish.redraw_every_frame ? frame_number : 0, kRobotPurpose);
    add_random_group(scene, camera, wish, random, robots);
  }
  return robots;
}

std::vector<ClutterDisc> random_clutter_in_frame(const Scene& scene, const CameraModel& camera,
                                                 std::uint64_t seed, std::uint64_t frame_number,
                                                 const std::vector<RobotPlacement>& robots) {
  std::vector<ClutterDisc> discs;
  const SceneClutter& clutter = scene.clutter;
  RandomStream random(seed, frame_number, kClutterPurpose);
  double reach_m = clutter.random_radius_m;
  for (const RobotBody& body : scene.bodies) {
    reach_m = std::max(reach_m, body.radius_m + 1.5 * clutter.random_radius_m);
  }
  for (int i = 0; i < clutter.random_count; ++i) {
    for (int attempt = 0; attempt < kTriesPerRobot; ++attempt) {
      const Eigen::Vector2d place_m = random_place(camera, clutter.random_radius_m, random);
      if (!clear_of(robots, place_m, reach_m)) continue;
      discs.push_back(
          {.place_m = place_m,
           .radius_m = clutter.random_radius_m,
           .height_m = clutter.random_radius_m,
           .colour = clutter.random_colours.at(random.below(clutter.random_colours.size()))});
      break;
    }
  }
  return discs;
}

std::vector<RobotTruth> truth_of(const Scene& scene, const CameraModel& camera,
                                 const std::vector<RobotPlacement>& robots) {
  std::vector<RobotTruth> truth;
  for (const RobotPlacement& robot : robots) {
    const MarkerLayout& layout = scene.layouts.at(robot.layout);
    const PixelPoint pixel = camera.project({robot.motion.x_m, robot.motion.y_m, layout.height_m});
    if (!camera.sees(pixel, -0.5)) continue;
    truth.push_back({robot.id, layout.teams.at(robot.team).name, robot.layout, robot.motion.x_m,
                     robot.motion.y_m, robot.motion.heading_rad, pixel.x(), pixel.y()});
  }
  return truth;
}

}  // namespace nadir::vision
