#include "tests/tracker/synthetic_setup.h"

#include <filesystem>

#include "calibration/fit/fit.h"
#include "vision/synthetic/recording.h"
#include "vision/synthetic/scene.h"

namespace nadir::tracker {

SyntheticCamera synthetic_camera(const std::string& scene_name, std::uint64_t seed) {
  const auto file = std::filesystem::path(NADIR_DATA_DIR) / "scenes" / (scene_name + ".yaml");
  const vision::Scene scene = vision::load_scene(file);
  vision::Renderer renderer(scene, seed);
  calibration::FieldPoints points;
  for (const vision::CalibrationPoint& point :
       vision::calibration_points(scene, renderer.camera(), seed)) {
    points.points.push_back({point.pixel, point.world_m, 0});
  }
  calibration::Calibration calibration{.map = calibration::fit_polynomial2(points, {}).map,
                                       .height_m = scene.points.height_m,
                                       .image_width_px = renderer.camera().width_px(),
                                       .image_height_px = renderer.camera().height_px(),
                                       .points_box = calibration::pixel_box(points)};
  PipelineSetup setup{.camera = "synthetic",
                      .calibration = std::move(calibration),
                      .calibration_file = scene_name,
                      .layouts = scene.layouts};
  return {std::move(renderer), std::move(setup)};
}

vision::Frame rendered_frame(vision::Renderer& renderer, std::uint64_t number) {
  vision::Frame frame;
  frame.number = number;
  frame.capture_time = renderer.capture_time(number);
  renderer.render(number, frame.image);
  return frame;
}

}  // namespace nadir::tracker
