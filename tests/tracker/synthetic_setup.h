#pragma once

#include <string>

#include "tracker/camera_pipeline.h"
#include "vision/synthetic/renderer.h"

namespace nadir::tracker {

/// A synthetic camera and a pipeline's setup for it, calibrated from the scene's own points as a
/// user would do it. The scene is one of data/scenes.
struct SyntheticCamera {
  vision::Renderer renderer;
  PipelineSetup setup;
};

SyntheticCamera synthetic_camera(const std::string& scene_name, std::uint64_t seed);

/// A frame of the synthetic camera as a source would give it.
vision::Frame rendered_frame(vision::Renderer& renderer, std::uint64_t number);

}  // namespace nadir::tracker
