#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vision/synthetic/camera_model.h"
#include "vision/synthetic/robot_path.h"
#include "vision/synthetic/scene.h"

namespace nadir::vision {

/// One robot in one frame, at mid-exposure.
struct RobotPlacement {
  std::size_t layout = 0;  ///< index into Scene::layouts
  std::size_t team = 0;    ///< index into MarkerLayout::teams
  int id = 0;
  RobotMotion motion;
};

/// What is true of one robot in one frame: the contract's truth.jsonl.
struct RobotTruth {
  int id = 0;
  std::string team;
  std::size_t layout = 0;
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
  double u_px = 0.0;  ///< image of the robot's origin at marker height
  double v_px = 0.0;
};

/// Robots of a frame: those on paths first, then the random ones. A pure function of its arguments.
std::vector<RobotPlacement> placements_in_frame(const Scene& scene, const CameraModel& camera,
                                                std::uint64_t seed, std::uint64_t frame_number);

/// Random clutter of a frame, clear of the robots.
std::vector<ClutterDisc> random_clutter_in_frame(const Scene& scene, const CameraModel& camera,
                                                 std::uint64_t seed, std::uint64_t frame_number,
                                                 const std::vector<RobotPlacement>& robots);

/// Truth of robots whose origin lies in the image.
std::vector<RobotTruth> truth_of(const Scene& scene, const CameraModel& camera,
                                 const std::vector<RobotPlacement>& robots);

}  // namespace nadir::vision
