#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tracker/alignment/mosaic.h"
#include "tracker/landmark_monitor.h"
#include "tracker/robot_tracks.h"

namespace nadir::tracker {

/// How fast frames of a recording are taken.
enum class Pace {
  kRecorded,  ///< as far apart as they were captured
  kFastest,   ///< one after the other
};
extern const std::vector<std::string> kPaceNames;  ///< in the order of Pace

/// Where covariances come from; the last three are those of the markers' centres
/// (calibration/pixel_count_variance.h).
enum class VarianceModel {
  kFisher,  ///< the Fisher information of the pixels with which a pose was aligned
  kPixels,  ///< no alignment: as the detector finds it in the scatter of each disc's pixels
  kLaw,     ///< variance proportional to 1 / pixel count, with the constant of the papers
  kTable,   ///< as the file `noise` says, from the pixel count
};
extern const std::vector<std::string> kVarianceNames;  ///< in the order of VarianceModel

/// `name` must be one of the names.
Pace pace_from_name(const std::string& name);
VarianceModel variance_from_name(const std::string& name);

/// One camera of a tracker. Paths as a program may open them.
struct CameraConfig {
  std::string name;
  std::string source;  ///< folder, video file, v4l2:DEVICE or synthetic:SCENE
  std::filesystem::path calibration;
  std::vector<std::filesystem::path> layouts;
  double rate_hz = 30.0;          ///< of recordings that bring no capture times
  std::filesystem::path colours;  ///< empty: the default colours
  /// Variance against pixel count, for kTable; error that alignment does not see, for kFisher.
  std::filesystem::path noise;
  VarianceModel variance = VarianceModel::kFisher;
  std::optional<Mosaic> mosaic;     ///< of the sensor's colours; nothing: recognised by the noise
  std::vector<Landmark> landmarks;  ///< that stand where they were surveyed; may be empty
};

/// Everything that a tracker can be told.
struct TrackerConfig {
  std::vector<CameraConfig> cameras;
  int domain = 0;
  std::string partition;
  bool publish = true;
  std::optional<Pace> pace;       ///< nothing: recorded when publishing, else fastest
  std::filesystem::path poses;    ///< empty: none; "-": standard output
  std::filesystem::path overlay;  ///< empty: none
  TrackSettings tracks;

  Pace effective_pace() const { return pace.value_or(publish ? Pace::kRecorded : Pace::kFastest); }
};

/// Reads TRACKER.yaml; relative paths are relative to its folder. Only `cameras` with source,
/// calibration and layouts is needed:
///
///     domain: 0
///     cameras:
///       - name: north
///         source: recordings/north
///         calibration: north.yaml
///         layouts: [../layouts/league.yaml]
///
/// Throws InputError: unknown, duplicate or missing key, value out of range, two cameras of one
/// name.
TrackerConfig load_tracker_config(const std::filesystem::path& file);

/// The whole configuration as YAML that load_tracker_config reads back.
std::string to_yaml(const TrackerConfig& config);

/// Throws InputError if a camera lacks something or two cannot be told apart. `file` is for the
/// message.
void check(const TrackerConfig& config, const std::string& file);

}  // namespace nadir::tracker
