#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

#include "vision/frame.h"
#include "vision/synthetic/camera_model.h"
#include "vision/synthetic/image_sensor.h"
#include "vision/synthetic/robot_placement.h"
#include "vision/synthetic/scene.h"
#include "vision/synthetic/scene_light.h"
#include "vision/synthetic/sprite.h"

namespace nadir::vision {

/// The synthetic camera: light of the scene, blurred by the optics, integrated by the pixels,
/// digitised by the sensor. A frame is a pure function of scene, seed and frame number: any frame
/// can be made alone. One per thread.
class Renderer {
 public:
  /// Throws std::invalid_argument where the scene cannot be shown (camera, indices, no room for
  /// random robots).
  Renderer(Scene scene, std::uint64_t seed);

  /// The frame with the scene's own robots. `bgr` becomes CV_8UC3 of the camera's size.
  void render(std::uint64_t frame_number, cv::Mat& bgr);
  /// The same frame with these robots instead (poses at mid-exposure): for live poses of a
  /// simulation.
  void render_robots(std::uint64_t frame_number, std::span<const RobotPlacement> robots,
                     cv::Mat& bgr);

  /// The scene's own robots in a frame.
  std::vector<RobotPlacement> placements(std::uint64_t frame_number) const;
  /// What is true of them; robots whose origin is out of the image are left out.
  std::vector<RobotTruth> truth(std::uint64_t frame_number) const;
  std::vector<RobotTruth> truth_of(std::span<const RobotPlacement> robots) const;
  /// Middle of the exposure: a fixed epoch (1 700 000 000 s) plus frame / rate.
  CaptureTime capture_time(std::uint64_t frame_number) const;

  const Scene& scene() const { return scene_; }
  const CameraModel& camera() const { return camera_; }

 private:
  void make_background();
  void blend(const SpritePatch& patch, int v, float* row) const;
  Sprite robot_sprite(const RobotPlacement& robot) const;
  void paint_sprites(std::uint64_t frame_number, std::span<const RobotPlacement> robots,
                     const ShadowEdge* shadow);

  Scene scene_;
  std::uint64_t seed_;
  CameraModel camera_;
  LightField light_;
  SpritePainter painter_;
  ImageSensor sensor_;
  cv::Mat background_;  ///< CV_32FC3, grey levels without noise and shadow
  std::vector<SpritePatch> patches_;
  std::size_t patch_count_ = 0;
  std::vector<float> row_;
  std::vector<float> shadow_row_;
  cv::Mat mosaic_;
};

}  // namespace nadir::vision
