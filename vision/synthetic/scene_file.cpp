#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "vision/input/strict_yaml.h"
#include "vision/synthetic/scene.h"
#include "vision/synthetic/scene_file_live.h"
#include "vision/synthetic/scene_file_paths.h"

namespace nadir::vision {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTiny = 1e-6;

const std::vector<std::string> kMosaics = {"none", "rggb", "bggr", "grbg", "gbrg"};
const std::vector<std::string> kColours(kColourNames.begin(), kColourNames.end());

/// A list [red, green, blue] as the files have it.
Reflectance colour_or(const YamlMap& map, const std::string& key, const Reflectance& fallback,
                      double highest = 1.0) {
  if (!map.has(key)) return fallback;
  const std::vector<double> rgb = map.numbers(key, 3, {0.0, highest});
  return {static_cast<float>(rgb[2]), static_cast<float>(rgb[1]), static_cast<float>(rgb[0])};
}

/// The layouts that a scene names, each read once.
class LayoutShelf {
 public:
  LayoutShelf(std::filesystem::path folder, Scene& scene)
      : folder_(std::move(folder)), scene_(scene) {}

  /// Index into Scene::layouts of the layout that `map` names.
  std::size_t layout_of(const YamlMap& map) { return layout_of(map, "layout", map.text("layout")); }
  std::size_t layout_of(const YamlMap& map, const std::string& key, const std::string& name) {
    const auto known = indices_.find(name);
    if (known != indices_.end()) return known->second;
    const std::filesystem::path file = folder_ / name;
    if (!std::filesystem::exists(file)) {
      throw map.error(key, "there is no layout file '" + name + "'",
                      "name it relative to the scene file");
    }
    scene_.layouts.push_back(load_marker_layout(file));
    scene_.bodies.push_back(default_body(scene_.layouts.back()));
    return indices_[name] = scene_.layouts.size() - 1;
  }

  std::size_t team_of(const YamlMap& map, const std::string& key, std::size_t layout,
                      const std::string& name) const {
    const std::vector<Team>& teams = scene_.layouts[layout].teams;
    std::string names;
    for (std::size_t i = 0; i < teams.size(); ++i) {
      if (teams[i].name == name) return i;
      names += (i == 0 ? "" : ", ") + teams[i].name;
    }
    throw map.error(key, "the layout has no team '" + name + "'", "choose one of " + names);
  }

  void read_body(const YamlMap& map, std::size_t layout) {
    RobotBody& body = scene_.bodies[layout];
    body.radius_m = map.number_or("body_radius_m", body.radius_m, {0.0, 2.0});
    body.front_m = map.number_or("body_front_m", body.front_m, {0.0, 2.0});
    body.colour = colour_or(map, "body_colour", body.colour);
  }

 private:
  std::filesystem::path folder_;
  Scene& scene_;
  std::map<std::string, std::size_t> indices_;
};

void read_light(const YamlMap& map, SceneLight& light) {
  light.level = map.number_or("level", light.level, {0.0, 10.0});
  light.white_grey = map.number_or("white_grey", light.white_grey, {1.0, 255.0});
  light.colour = colour_or(map, "colour", light.colour, 4.0);
  light.vignette = map.number_or("vignette", light.vignette, {0.0, 1.0});
  light.gradient_u = map.number_or("gradient_u", light.gradient_u, {-2.0, 2.0});
  light.gradient_v = map.number_or("gradient_v", light.gradient_v, {-2.0, 2.0});
  if (const auto edge = map.map_if_present("shadow")) {
    SceneShadow shadow;
    shadow.u_px = edge->number_or("u_px", shadow.u_px);
    shadow.v_px = edge->number_or("v_px", shadow.v_px);
    shadow.angle_rad = kRadians * edge->number_or("angle_deg", shadow.angle_rad / kRadians);
    shadow.factor = edge->number_or("factor", shadow.factor, {0.0, 1.0});
    shadow.softness_px = edge->number_or("softness_px", shadow.softness_px, {0.0, 1000.0});
    shadow.random = edge->boolean_or("random", shadow.random);
    edge->finish();
    light.shadow = shadow;
  }
  map.finish();
}

void read_sensor(const YamlMap& map, SceneSensor& sensor) {
  const std::string mosaic = map.choice_or("mosaic", "none", kMosaics);
  const auto index = std::find(kMosaics.begin(), kMosaics.end(), mosaic) - kMosaics.begin();
  sensor.mosaic = static_cast<SceneSensor::Mosaic>(index);
  sensor.full_well_electrons =
      map.number_or("full_well_electrons", sensor.full_well_electrons, {10.0, 1e9});
  sensor.read_noise_electrons =
      map.number_or("read_noise_electrons", sensor.read_noise_electrons, {0.0, 1e6});
  sensor.noise = map.boolean_or("noise", sensor.noise);
  sensor.gamma = map.number_or("gamma", sensor.gamma, {0.2, 5.0});
  sensor.exposure_s = 1e-3 * map.number_or("exposure_ms", 1e3 * sensor.exposure_s, {0.0, 1000.0});
  map.finish();
}

void read_floor(const YamlMap& map, SceneFloor& floor) {
  floor.colour = colour_or(map, "colour", floor.colour);
  floor.texture = map.number_or("texture", floor.texture, {0.0, 0.5});
  floor.line_colour = colour_or(map, "line_colour", floor.line_colour);
  if (map.has("lines")) {
    for (const YamlMap& entry : map.maps("lines")) {
      FloorLine line;
      const std::vector<double> from = entry.numbers("from_m", 2);
      const std::vector<double> to = entry.numbers("to_m", 2);
      line.from_m = {from[0], from[1]};
      line.to_m = {to[0], to[1]};
      line.width_m = entry.number_or("width_m", line.width_m, {kTiny, 10.0});
      if (line.from_m == line.to_m)
        throw entry.error("to_m", "the line has no length", "move an end");
      entry.finish();
      floor.lines.push_back(line);
    }
  }
  map.finish();
}

void read_clutter(const YamlMap& map, SceneClutter& clutter) {
  if (map.has("discs")) {
    for (const YamlMap& entry : map.maps("discs")) {
      ClutterDisc disc;
      disc.place_m = {entry.number("x_m"), entry.number("y_m")};
      disc.radius_m = entry.number_or("radius_m", disc.radius_m, {kTiny, 2.0});
      disc.height_m = entry.number_or("height_m", disc.radius_m, {0.0, 10.0});
      disc.colour = colour_from_name(entry.choice_or("colour", "orange", kColours));
      disc.shading = entry.number_or("shading", disc.shading, {0.0, 1.0});
      entry.finish();
      clutter.discs.push_back(disc);
    }
  }
  clutter.random_count = map.integer_or("random_count", 0, {0, 1000});
  clutter.random_radius_m = map.number_or("random_radius_m", clutter.random_radius_m, {kTiny, 2.0});
  if (map.has("random_colours")) {
    clutter.random_colours.clear();
    for (const std::string& name : map.texts("random_colours")) {
      if (std::find(kColours.begin(), kColours.end(), name) == kColours.end()) {
        throw map.error("random_colours", "there is no colour '" + name + "'",
                        "blue, yellow, pink, green, orange, white and black exist");
      }
      clutter.random_colours.push_back(colour_from_name(name));
    }
    if (clutter.random_colours.empty()) {
      throw map.error("random_colours", "the list is empty", "name a colour");
    }
  }
  map.finish();
}

void read_robot(const YamlMap& map, LayoutShelf& shelf, Scene& scene) {
  SceneRobot robot;
  robot.layout = shelf.layout_of(map);
  const MarkerLayout& layout = scene.layouts[robot.layout];
  robot.team =
      shelf.team_of(map, "team", robot.layout, map.text_or("team", layout.teams.front().name));
  const std::vector<int> ids = layout.robot_ids();
  robot.id =
      map.integer_or("id", ids.empty() ? static_cast<int>(scene.robots.size()) : ids.front());
  if (!layout.has_robot(robot.id)) {
    throw map.error("id", "the layout has no robot " + std::to_string(robot.id),
                    "choose one of the layout's robots");
  }
  shelf.read_body(map, robot.layout);
  if (const auto path = map.map_if_present("path")) robot.path = read_robot_path(*path);
  map.finish();
  scene.robots.push_back(robot);
}

void read_random_robots(const YamlMap& map, LayoutShelf& shelf, Scene& scene) {
  RandomRobots wish;
  wish.layout = shelf.layout_of(map);
  const MarkerLayout& layout = scene.layouts[wish.layout];
  if (map.has("teams")) {
    std::set<std::size_t> teams;
    for (const std::string& name : map.texts("teams")) {
      teams.insert(shelf.team_of(map, "teams", wish.layout, name));
    }
    wish.teams.assign(teams.begin(), teams.end());
  } else {
    for (std::size_t i = 0; i < layout.teams.size(); ++i) wish.teams.push_back(i);
  }
  wish.count = map.integer("count", {1, 1000});
  const std::size_t names = wish.teams.size() * layout.robot_ids().size();
  if (!layout.is_anonymous() && static_cast<std::size_t>(wish.count) > names) {
    throw map.error("count", "there are only " + std::to_string(names) + " teams and robots",
                    "ask for fewer robots");
  }
  if (wish.teams.empty()) throw map.error("teams", "the list is empty", "name a team");
  wish.border_margin_px = map.number_or("border_margin_px", wish.border_margin_px, {-1e4, 1e4});
  wish.minimum_distance_m =
      map.number_or("minimum_distance_m", wish.minimum_distance_m, {0.0, 100.0});
  wish.redraw_every_frame = map.boolean_or("redraw_every_frame", wish.redraw_every_frame);
  shelf.read_body(map, wish.layout);
  map.finish();
  scene.random_robots.push_back(wish);
}

void read_live_robots(const YamlMap& map, LayoutShelf& shelf, Scene& scene) {
  SceneLiveRobots live;
  for (const std::string& name : map.texts("layouts")) {
    live.layouts.push_back(shelf.layout_of(map, "layouts", name));
    shelf.read_body(map, live.layouts.back());
  }
  if (live.layouts.empty()) throw map.error("layouts", "the list is empty", "name a layout");
  live.hold_s = 1e-3 * map.number_or("hold_ms", 1e3 * live.hold_s, {1.0, 60000.0});
  map.finish();
  scene.live_robots = live;
}

/// Throws if the lens cannot exist.
void read_camera(const YamlMap& map, Scene& scene) {
  CameraParameters& camera = scene.camera;
  camera.width_px = map.integer_or("width_px", camera.width_px, {16, 16384});
  camera.height_px = map.integer_or("height_px", camera.height_px, {16, 16384});
  camera.height_m = map.number_or("height_m", camera.height_m, {0.1, 1000.0});
  camera.x_m = map.number_or("x_m", camera.x_m);
  camera.y_m = map.number_or("y_m", camera.y_m);
  camera.tilt_rad = kRadians * map.number_or("tilt_deg", 0.0, {0.0, 60.0});
  camera.tilt_direction_rad = kRadians * map.number_or("tilt_direction_deg", 0.0);
  camera.pan_rad = kRadians * map.number_or("pan_deg", 0.0);
  camera.k1 = map.number_or("k1", 0.0, {-2.0, 2.0});
  camera.k2 = map.number_or("k2", 0.0, {-2.0, 2.0});
  camera.centre_u_px = map.number_or("centre_u_px", 0.5 * (camera.width_px - 1));
  camera.centre_v_px = map.number_or("centre_v_px", 0.5 * (camera.height_px - 1));
  const bool has_focal = map.has("focal_px");
  const bool has_view = map.has("field_of_view_deg");
  const bool has_scale = map.has("pixels_per_metre");
  if (has_focal + has_view + has_scale > 1) {
    throw map.error("focal_px", "the focal length is given more than once",
                    "keep one of focal_px, field_of_view_deg, pixels_per_metre");
  }
  const double marker_height_m = scene.layouts.empty() ? 0.0 : scene.layouts.front().height_m;
  if (marker_height_m >= camera.height_m) {
    throw map.error("height_m", "the camera hangs below the marks", "hang it higher");
  }
  camera.focal_px = camera.width_px;
  if (has_focal) camera.focal_px = map.number("focal_px", {1.0, 1e6});
  if (has_view) {
    const double view_rad = kRadians * map.number("field_of_view_deg", {0.1, 170.0});
    camera.focal_px = 0.5 * camera.width_px / std::tan(0.5 * view_rad);
  }
  if (has_scale) {
    camera.focal_px =
        map.number("pixels_per_metre", {kTiny, 1e6}) * (camera.height_m - marker_height_m);
  }
  scene.rate_hz = map.number_or("rate_hz", scene.rate_hz, {kTiny, 1e5});
  map.finish();
  try {
    const CameraModel possible(camera);
  } catch (const std::invalid_argument& cause) {
    throw map.error("k1", cause.what(), "choose a weaker distortion or a longer focal length");
  }
}

void read_points(const YamlMap& map, ScenePoints& points) {
  points.columns = map.integer_or("columns", points.columns, {2, 1000});
  points.rows = map.integer_or("rows", points.rows, {2, 1000});
  points.height_m = map.number_or("height_m", points.height_m, {0.0, 100.0});
  points.noise_px = map.number_or("noise_px", points.noise_px, {0.0, 1000.0});
  points.survey_noise_m = map.number_or("survey_noise_m", points.survey_noise_m, {0.0, 100.0});
  map.finish();
}

}  // namespace

Scene load_scene(const std::filesystem::path& file) {
  const YamlMap map = YamlMap::load(file);
  Scene scene;
  LayoutShelf shelf(file.parent_path(), scene);
  if (map.has("robots")) {
    for (const YamlMap& entry : map.maps("robots")) read_robot(entry, shelf, scene);
  }
  if (map.has("random_robots")) {
    for (const YamlMap& entry : map.maps("random_robots")) read_random_robots(entry, shelf, scene);
  }
  if (const auto live = map.map_if_present("live_robots")) read_live_robots(*live, shelf, scene);
  // The camera's scale and the points' height refer to the first layout, so they come after the
  // robots.
  read_camera(map.has("camera") ? map.map("camera") : YamlMap::parse("{}", file.string()), scene);
  if (!scene.layouts.empty()) scene.points.height_m = scene.layouts.front().height_m;
  if (const auto points = map.map_if_present("points")) read_points(*points, scene.points);
  if (const auto optics = map.map_if_present("optics")) {
    scene.point_spread_px =
        optics->number_or("point_spread_px", scene.point_spread_px, {0.0, 50.0});
    scene.samples_per_px = optics->integer_or("samples_per_px", scene.samples_per_px, {0, 16});
    optics->finish();
  }
  if (const auto sensor = map.map_if_present("sensor")) read_sensor(*sensor, scene.sensor);
  if (const auto light = map.map_if_present("light")) read_light(*light, scene.light);
  if (const auto floor = map.map_if_present("floor")) read_floor(*floor, scene.floor);
  if (const auto clutter = map.map_if_present("clutter")) read_clutter(*clutter, scene.clutter);
  if (const auto delivery = map.map_if_present("delivery")) {
    if (!scene.live_robots) {
      throw map.error("delivery", "only a scene with live_robots is a camera in real time",
                      "remove it, or add live_robots");
    }
    scene.delivery = read_delivery(*delivery);
  }
  scene.frames = static_cast<std::uint64_t>(map.integer_or("frames", 0, {0, kInfinity}));
  map.finish();
  return scene;
}

}  // namespace nadir::vision
