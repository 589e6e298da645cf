#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/calibration_file.h"
#include "calibration/pixel_count_variance.h"
#include "calibration/plane_map.h"
#include "tracker/alignment/mosaic.h"
#include "tracker/robot_tracks.h"
#include "vision/colour_classes.h"
#include "vision/marker_layout.h"

namespace nadir::tracker {

/// What poses and covariances are made of.
enum class PoseSource {
  kAlignment,         ///< pixels aligned with the layout's template; covariance of Fisher
  kAlignedAndCounts,  ///< the same poses with covariances from the discs' pixel counts
  kDetector,          ///< discs as the detector measures them, covariances from `variance`
};

/// Everything that makes poses of one camera's frames.
struct PipelineSetup {
  std::string camera;  ///< its name
  calibration::Calibration calibration;
  std::filesystem::path calibration_file;     ///< for messages
  std::vector<vision::MarkerLayout> layouts;  ///< at least one, with different team names
  vision::ColourClasses colours = vision::default_colour_classes();
  /// Of the discs' centres; by default from their own pixels.
  calibration::PixelCountVariance variance = {};
  TrackSettings tracks = {};
  PoseSource source = PoseSource::kAlignment;
  std::optional<Mosaic> mosaic = {};  ///< of the sensor; nothing: recognised by the noise
  /// Error of an aligned mark, per axis, that neither noise nor residuals tell of; nothing: as
  /// small as the synthetic camera shows it.
  std::optional<double> alignment_floor_px = {};

  bool aligns() const { return source != PoseSource::kDetector; }
};

/// Throws InputError if frames of this size are not the calibration's or a team's name is in two
/// layouts. Layouts with tags come last in what is returned: so an index counts discs' layouts
/// alone and all of them.
PipelineSetup checked(PipelineSetup setup, int width_px, int height_px);

/// Of the plane of each layout's markers.
std::vector<calibration::PlaneMap> maps_of(const PipelineSetup& setup);

}  // namespace nadir::tracker
