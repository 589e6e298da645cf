#pragma once

#include <string>
#include <vector>

#include "tracker/camera_pipeline.h"
#include "tracker/tracker_config.h"

namespace nadir::tracker {

/// Reads the files that a camera's configuration names. Throws InputError with the file and line of
/// what is wrong.
PipelineSetup load_pipeline_setup(const CameraConfig& config, const TrackSettings& tracks);

/// What a person should know of a setup although it works, one line each: layouts whose markers are
/// not at the height for which the calibration was made.
std::vector<std::string> setup_warnings(const PipelineSetup& setup);

/// The same for frames of a size that the calibration does not state: its points leave much of the
/// image out, so it is that of another image size or extrapolates. Empty where all is well.
std::string coverage_warning(const PipelineSetup& setup, int width_px, int height_px);

}  // namespace nadir::tracker
