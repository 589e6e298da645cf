#pragma once

#include <functional>
#include <string>
#include <vector>

#include "calibration/fit/fit.h"
#include "calibration/plane_map.h"
#include "tracker/tag_robots.h"
#include "vision/synthetic/recording.h"
#include "vision/synthetic/renderer.h"
#include "vision/synthetic/scene.h"

namespace nadir::tracker {

/// A camera that looks straight down on robots with tags, with a perfect lens, so that a polynomial
/// of order 2 is an exact calibration: whatever errs is the tags' measurement.
struct TagCamera {
  vision::Renderer renderer;
  calibration::PlaneMap map;
  vision::MarkerLayout layout;
};

enum class TagLight { kEven, kBayer, kDim };

/// `side_px`: of the tags' squares. Ten robots (five large ones), at new places in every frame.
/// `change`: of the scene.
inline TagCamera tag_camera(double side_px, TagLight light, std::uint64_t seed,
                            const std::function<void(vision::Scene&)>& change = {}) {
  const std::string folder = std::string(NADIR_DATA_DIR) + "/scenes/";
  vision::Scene scene =
      vision::load_scene(folder + (light == TagLight::kDim ? "tags_dim.yaml" : "tags_even.yaml"));
  if (light == TagLight::kBayer) scene.sensor.mosaic = vision::SceneSensor::Mosaic::kRggb;
  scene.random_robots.front().count = side_px > 50.0 ? 5 : 10;
  const vision::MarkerLayout layout = scene.layouts.front();
  scene.camera.tilt_rad = 0.0;
  scene.camera.k1 = 0.0;
  scene.camera.width_px = 640;
  scene.camera.height_px = 512;
  scene.camera.centre_u_px = 319.5;
  scene.camera.centre_v_px = 255.5;
  scene.camera.focal_px = side_px / layout.tags->size_m * (scene.camera.height_m - layout.height_m);
  if (change) change(scene);
  vision::Renderer renderer(scene, seed);
  calibration::FieldPoints points;
  for (const vision::CalibrationPoint& point :
       vision::calibration_points(scene, renderer.camera(), seed)) {
    points.points.push_back({point.pixel, point.world_m, 0});
  }
  return {std::move(renderer), calibration::fit_polynomial2(points, {}).map, layout};
}

inline vision::Frame frame_of(vision::Renderer& renderer, std::uint64_t number) {
  vision::Frame frame;
  frame.number = number;
  frame.capture_time = renderer.capture_time(number);
  renderer.render(number, frame.image);
  return frame;
}

/// Errors of a tracker's poses against the truth.
struct TagErrors {
  int shown = 0;
  int found = 0;
  int wrong = 0;             ///< a robot that is not there, or more than a side away from its place
  double place_px = 0.0;     ///< RMS per axis
  double heading_deg = 0.0;  ///< RMS
  double nees = 0.0;         ///< mean of three degrees of freedom
  double worst_nees = 0.0;
};

}  // namespace nadir::tracker
