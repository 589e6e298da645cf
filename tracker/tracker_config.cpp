#include "tracker/tracker_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "tracker/wire/wire_options.h"
#include "tracker/wire/wire_types.h"
#include "vision/input/strict_yaml.h"

namespace nadir::tracker {

const std::vector<std::string> kPaceNames = {"recorded", "fastest"};
const std::vector<std::string> kVarianceNames = {"fisher", "pixels", "law", "table"};

Pace pace_from_name(const std::string& name) {
  return static_cast<Pace>(std::ranges::find(kPaceNames, name) - kPaceNames.begin());
}

VarianceModel variance_from_name(const std::string& name) {
  return static_cast<VarianceModel>(std::ranges::find(kVarianceNames, name) -
                                    kVarianceNames.begin());
}

namespace {

using vision::InputError;
using vision::YamlMap;
namespace fs = std::filesystem;

// The two ranges that nobody's robots leave: they catch wrong units.
constexpr vision::ValidRange kRate_hz{0.01, 10000.0};
constexpr vision::ValidRange kSpeed_mps{0.01, 100.0};

fs::path resolve(const fs::path& folder, const std::string& text) {
  if (text.empty() || text == "-" || fs::path(text).is_absolute()) return text;
  return (folder / text).lexically_normal();
}

// A source is a path with or without a scheme; devices of v4l2 are no files of the configuration.
std::string resolve_source(const fs::path& folder, const std::string& source) {
  constexpr std::string_view kSynthetic = "synthetic:";
  if (source.starts_with(kSynthetic)) {
    return std::string(kSynthetic) + resolve(folder, source.substr(kSynthetic.size())).string();
  }
  return source.find(':') != std::string::npos ? source : resolve(folder, source).string();
}

std::vector<Landmark> read_landmarks(const YamlMap& camera, const std::string& name) {
  constexpr vision::ValidRange kPlace_m{-1e4, 1e4};
  std::vector<Landmark> landmarks;
  if (!camera.has("landmarks")) return landmarks;
  for (const YamlMap& map : camera.maps("landmarks")) {
    landmarks.push_back({.camera = name,
                         .team = map.text("team"),
                         .id = map.integer_or("id", -1, {0.0, 1e6}),
                         .place_m = {map.number("x_m", kPlace_m), map.number("y_m", kPlace_m)}});
    map.finish();
  }
  return landmarks;
}

CameraConfig read_camera(const YamlMap& map, const fs::path& folder, std::size_t index) {
  CameraConfig camera;
  camera.name = map.text_or("name", fmt::format("cam{}", index));
  camera.source = resolve_source(folder, map.text("source"));
  camera.calibration = resolve(folder, map.text("calibration"));
  for (const std::string& layout : map.texts("layouts")) {
    camera.layouts.push_back(resolve(folder, layout));
  }
  camera.rate_hz = map.number_or("rate_hz", camera.rate_hz, kRate_hz);
  camera.colours = resolve(folder, map.text_or("colours", ""));
  camera.noise = resolve(folder, map.text_or("noise", ""));
  const std::string& by_file = kVarianceNames[camera.noise.empty() ? 0 : 3];
  camera.variance = variance_from_name(map.choice_or("variance", by_file, kVarianceNames));
  camera.mosaic = mosaic_from_name(map.choice_or("mosaic", kMosaicNames.back(), kMosaicNames));
  camera.landmarks = read_landmarks(map, camera.name);
  map.finish();
  return camera;
}

TrackSettings read_tracks(const YamlMap& map) {
  TrackSettings tracks;
  tracks.speed_limit_mps = map.number_or("speed_limit_mps", tracks.speed_limit_mps, kSpeed_mps);
  tracks.lost_after_s = map.number_or("lost_after_s", tracks.lost_after_s, {0.0, 60.0});
  tracks.same_place_m = map.number_or("same_place_m", tracks.same_place_m, {0.0, 1.0});
  tracks.confident_reading =
      map.number_or("confident_reading", tracks.confident_reading, {0.0, 1.0});
  map.finish();
  return tracks;
}

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

void put_camera(std::string& yaml, const CameraConfig& camera) {
  std::string layouts;
  for (const fs::path& layout : camera.layouts) {
    layouts += (layouts.empty() ? "" : ", ") + quoted(layout.string());
  }
  const auto out = std::back_inserter(yaml);
  fmt::format_to(out, "  - name: {}\n    source: {}\n    calibration: {}\n    layouts: [{}]\n",
                 quoted(camera.name), quoted(camera.source), quoted(camera.calibration.string()),
                 layouts);
  fmt::format_to(out, "    rate_hz: {}\n    colours: {}\n    noise: {}\n    variance: {}\n",
                 camera.rate_hz, quoted(camera.colours.string()), quoted(camera.noise.string()),
                 kVarianceNames[static_cast<std::size_t>(camera.variance)]);
  fmt::format_to(out, "    mosaic: {}\n", mosaic_name(camera.mosaic));
  if (!camera.landmarks.empty()) yaml += "    landmarks:\n";
  for (const Landmark& landmark : camera.landmarks) {
    const std::string id = landmark.id < 0 ? "" : fmt::format("id: {}, ", landmark.id);
    fmt::format_to(out, "      - {{team: {}, {}x_m: {}, y_m: {}}}\n", quoted(landmark.team), id,
                   landmark.place_m.x(), landmark.place_m.y());
  }
}

}  // namespace

TrackerConfig load_tracker_config(const fs::path& file) {
  const YamlMap map = YamlMap::load(file);
  const fs::path folder = file.parent_path();
  TrackerConfig config;
  config.domain = map.integer_or("domain", config.domain, {0.0, static_cast<double>(kMaxDomain)});
  config.partition = map.text_or("partition", "");
  config.publish = map.boolean_or("publish", config.publish);
  if (map.has("pace")) config.pace = pace_from_name(map.choice("pace", kPaceNames));
  config.poses = resolve(folder, map.text_or("poses", ""));
  config.overlay = resolve(folder, map.text_or("overlay", ""));
  if (const auto tracks = map.map_if_present("tracks")) config.tracks = read_tracks(*tracks);
  for (const YamlMap& camera : map.maps("cameras")) {
    config.cameras.push_back(read_camera(camera, folder, config.cameras.size()));
  }
  map.finish();
  check(config, file.string());
  return config;
}

std::string to_yaml(const TrackerConfig& config) {
  std::string yaml;
  const auto out = std::back_inserter(yaml);
  fmt::format_to(out, "domain: {}\npartition: {}\npublish: {}\npace: {}\nposes: {}\noverlay: {}\n",
                 config.domain, quoted(config.partition), config.publish,
                 kPaceNames[static_cast<std::size_t>(config.effective_pace())],
                 quoted(config.poses.string()), quoted(config.overlay.string()));
  fmt::format_to(out,
                 "tracks:\n  speed_limit_mps: {}\n  lost_after_s: {}\n  same_place_m: {}\n"
                 "  confident_reading: {}\ncameras:\n",
                 config.tracks.speed_limit_mps, config.tracks.lost_after_s,
                 config.tracks.same_place_m, config.tracks.confident_reading);
  for (const CameraConfig& camera : config.cameras) put_camera(yaml, camera);
  return yaml;
}

void check(const TrackerConfig& config, const std::string& file) {
  const auto fail = [&](const std::string& cause, const std::string& remedy) {
    throw InputError({file, 0, 0}, cause, remedy);
  };
  if (config.cameras.empty())
    fail("no camera is given", "name a source, a layout and a calibration");
  for (std::size_t i = 0; i < config.cameras.size(); ++i) {
    const CameraConfig& camera = config.cameras[i];
    if (camera.name.empty() || camera.name.size() > kMaxCameraLength) {
      fail(fmt::format("camera name '{}' has {} letters", camera.name, camera.name.size()),
           fmt::format("use 1 to {}", kMaxCameraLength));
    }
    if (camera.source.empty())
      fail("camera '" + camera.name + "' has no source", "give one with --source");
    if (camera.layouts.empty())
      fail("camera '" + camera.name + "' has no layout", "give one with --layout");
    if (camera.calibration.empty()) {
      fail("camera '" + camera.name + "' has no calibration",
           "make one with nadir-calibrate, give it with --calibration");
    }
    if (camera.variance == VarianceModel::kTable && camera.noise.empty()) {
      fail("camera '" + camera.name + "': the variance 'table' needs a noise file",
           "give one, as in --noise data/noise/goncalves2008.yaml");
    }
    const bool uses_noise =
        camera.variance == VarianceModel::kTable || camera.variance == VarianceModel::kFisher;
    if (!uses_noise && !camera.noise.empty()) {
      fail("camera '" + camera.name + "': a noise file is for the variances 'table' and 'fisher'",
           "leave the noise file or the variance out");
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (config.cameras[j].name == camera.name) {
        fail("two cameras have the name '" + camera.name + "'",
             "give each camera a name of its own");
      }
    }
  }
}

}  // namespace nadir::tracker
