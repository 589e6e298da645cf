#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "vision/marker_layout.h"
#include "vision/synthetic/camera_model.h"
#include "vision/synthetic/robot_path.h"

namespace nadir::vision {

/// Linear reflectance, blue green red; 1 is white paper.
using Reflectance = cv::Vec3f;

/// What the named colours reflect, taken from printed marks on a real photograph.
std::array<Reflectance, kColourCount> printed_reflectances();

struct SceneSensor {
  enum class Mosaic { kNone, kRggb, kBggr, kGrbg, kGbrg };

  Mosaic mosaic = Mosaic::kNone;       ///< colours of the top-left 2x2 pixels, row by row
  double full_well_electrons = 10000;  ///< at grey level 255
  double read_noise_electrons = 15;    ///< RMS
  bool noise = true;                   ///< false: no shot and no read noise
  double gamma = 1.0;                  ///< grey level = 255 (charge / full well)^(1/gamma)
  double exposure_s = 0.0;             ///< robots move during it; brightness does not depend on it
};

/// A straight edge, in the image, beyond which less light falls.
struct SceneShadow {
  double u_px = 640.0;  ///< a point of the edge
  double v_px = 512.0;
  double angle_rad =
      1.0;  ///< direction of the edge from the u axis towards v; the shadow is on its right (u, v)
  double factor = 0.5;       ///< light left in the shadow
  double softness_px = 2.0;  ///< RMS width of the transition
  bool random = false;       ///< another edge through the image's middle half in each frame
};

struct SceneLight {
  double level = 1.0;  ///< 1: white paper has grey level `white_grey`
  double white_grey = 240.0;
  Reflectance colour = {1, 1, 1};  ///< gain of blue, green, red
  double vignette = 0.0;           ///< share of light lost in the image's corners
  double gradient_u =
      0.0;  ///< light at the right border minus light at the left, share of the middle's
  double gradient_v = 0.0;  ///< bottom minus top
  std::optional<SceneShadow> shadow;
};

/// A straight painted line on the field.
struct FloorLine {
  Eigen::Vector2d from_m;
  Eigen::Vector2d to_m;
  double width_m = 0.02;
};

struct SceneFloor {
  Reflectance colour = {0.19F, 0.42F, 0.25F};  ///< green carpet
  double texture = 0.06;                       ///< RMS of the relative brightness
  std::vector<FloorLine> lines;
  Reflectance line_colour = {0.95F, 0.95F, 0.95F};
};

/// A ball or another round thing that is no robot.
struct ClutterDisc {
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
  double radius_m = 0.0215;
  double height_m = 0.0215;  ///< of its widest circle
  Colour colour = Colour::kOrange;
  double shading = 0.35;  ///< share of light lost towards the rim: 0 flat disc, balls more
};

struct SceneClutter {
  std::vector<ClutterDisc> discs;
  int random_count = 0;  ///< further discs at new places in each frame
  std::vector<Colour> random_colours = {Colour::kOrange};
  double random_radius_m = 0.0215;
};

/// The robot under the marks: a dark round plate in the marker plane, its front cut flat.
struct RobotBody {
  double radius_m = 0.09;
  double front_m = 0.09;  ///< the plate ends here in front; radius_m or more: a full circle
  Reflectance colour = {0.15F, 0.15F, 0.15F};
};

struct SceneRobot {
  std::size_t layout = 0;  ///< index into Scene::layouts
  std::size_t team = 0;    ///< index into MarkerLayout::teams
  int id = 0;              ///< one that the layout has (MarkerLayout::has_robot)
  RobotPath path;
};

/// Robots at random places, all of them wholly in the image.
struct RandomRobots {
  std::size_t layout = 0;
  std::vector<std::size_t> teams;  ///< no two robots have the same team and id
  int count = 0;
  double border_margin_px = 4.0;    ///< between a robot's rim and the image's border
  double minimum_distance_m = 0.2;  ///< between the centres of any two robots
  bool redraw_every_frame = true;
};

/// Robots that somebody else moves while the scene is shown (live_robots.h). Such a scene is a
/// camera in real time.
struct SceneLiveRobots {
  std::vector<std::size_t> layouts;  ///< that they may have, indices into Scene::layouts
  double hold_s = 0.5;               ///< a robot that was not heard of for longer is gone
};

/// A time without frames, seconds since the scene's start.
struct SceneBlackout {
  double start_s = 0.0;
  double length_s = 0.0;
};

/// How the frames of a scene in real time reach their reader: late, never, or at once as here.
struct SceneDelivery {
  double shortest_delay_s = 0.0;  ///< from the middle of the exposure; frames keep their order
  double longest_delay_s = 0.0;
  double loss = 0.0;  ///< share of frames that never arrive, below 1
  std::vector<SceneBlackout> blackouts;
};

/// Points of the marker plane for a calibration: a grid over the whole image.
struct ScenePoints {
  int columns = 12;
  int rows = 9;
  double height_m = 0.0;
  double noise_px = 0.0;
  double survey_noise_m = 0.0;
};

/// Everything that the synthetic camera shows. Filled by load_scene or in code; a default scene is
/// an empty carpet.
struct Scene {
  CameraParameters camera;
  double rate_hz = 60.0;
  std::uint64_t frames = 0;      ///< of a source; 0: endless
  double point_spread_px = 0.7;  ///< RMS radius per axis of the optics' Gaussian blur
  int samples_per_px = 0;        ///< of the grid that robots are painted on; 0: as fine as needed
  SceneSensor sensor;
  SceneLight light;
  SceneFloor floor;
  SceneClutter clutter;
  std::vector<MarkerLayout> layouts;
  std::vector<RobotBody> bodies;  ///< one for each layout
  std::vector<SceneRobot> robots;
  std::vector<RandomRobots> random_robots;
  std::optional<SceneLiveRobots> live_robots;
  SceneDelivery delivery;
  ScenePoints points;
};

/// The body that suits a layout: 5 mm more than its outermost mark, cut 10 mm before its foremost.
/// For the league's pattern that is a radius of 90 mm and a front flat at 65 mm. Under tags it is a
/// full circle.
RobotBody default_body(const MarkerLayout& layout);

/// Reads a scene. Layout files are named relative to the scene's. Throws InputError with
/// file:line:column.
Scene load_scene(const std::filesystem::path& file);

}  // namespace nadir::vision
