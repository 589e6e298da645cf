#include "tracker/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "tracker/wire/wire_options.h"
#include "vision/input/input_error.h"
#include "vision/input/usage_line.h"

namespace nadir::tracker {
namespace {

constexpr int kWrongUsage = 2;
constexpr const char* kExample =
    "Example:\n"
    "  nadir-tracker --source data/clips/demo/frames --layout data/layouts/league.yaml \\\n"
    "      --calibration data/calibrations/demo.yaml --poses poses.jsonl --overlay pictures "
    "--no-publish\n"
    "SOURCE is a folder of images (capture times from its times.csv, else --rate), a video file,\n"
    "v4l2:/dev/video0 or synthetic:SCENE.yaml.";

// As it was typed; nothing where it was not.
struct Typed {
  std::string config;
  std::optional<std::string> source;
  std::vector<std::string> layouts;
  std::optional<std::string> calibration;
  std::optional<std::string> camera;
  std::optional<double> rate_hz;
  std::optional<std::string> colours;
  std::optional<std::string> noise;
  std::optional<std::string> variance;
  std::optional<std::string> mosaic;
  std::optional<std::string> poses;
  std::optional<std::string> overlay;
  std::optional<int> domain;
  std::optional<std::string> partition;
  std::optional<std::string> pace;
  bool no_publish = false;
  bool print_config = false;
};

void add_camera_options(CLI::App& app, Typed& typed) {
  app.add_option("--source", typed.source, "where frames come from")->type_name("SOURCE");
  app.add_option("--layout", typed.layouts, "how robots look; again for each further kind of robot")
      ->type_name("LAYOUT.yaml")
      ->allow_extra_args(false);
  app.add_option("--calibration", typed.calibration, "pixels to metres, made by nadir-calibrate")
      ->type_name("CAL.yaml");
  app.add_option(
         "--camera", typed.camera,
         "the camera's name; with several cameras in --config: the one that the options are for")
      ->type_name("NAME");
  app.add_option("--rate", typed.rate_hz,
                 "frames per second of a recording without capture times (default 30)")
      ->type_name("HZ")
      ->check(CLI::Range(0.01, 10000.0));
  app.add_option("--colours", typed.colours,
                 "how the colours look to this camera (default: built in)")
      ->type_name("COLOURS.yaml");
  app.add_option("--noise", typed.noise,
                 "variance against pixel count; implies --variance table. With --variance fisher "
                 "only its alignment_floor_px counts")
      ->type_name("NOISE.yaml");
  app.add_option("--variance", typed.variance,
                 "where covariances come from: fisher (of the aligned pixels, default), law "
                 "(1 / pixel count), table (--noise), or pixels (of each disc's own, no alignment)")
      ->type_name("MODEL")
      ->check(CLI::IsMember(kVarianceNames));
  app.add_option("--mosaic", typed.mosaic,
                 "colours of the sensor's top-left 2x2 pixels, whose values alone are aligned "
                 "(default: auto, by the noise)")
      ->type_name("none|rggb|bggr|grbg|gbrg|auto")
      ->check(CLI::IsMember(kMosaicNames));
}

void add_run_options(CLI::App& app, Typed& typed) {
  app.add_option("--config", typed.config,
                 "several cameras and all options; the command line wins over it")
      ->type_name("TRACKER.yaml");
  app.add_option("--poses", typed.poses, "write JSON lines, one a frame; - is the standard output")
      ->type_name("FILE");
  app.add_option("--overlay", typed.overlay, "write a picture of each frame into this folder")
      ->type_name("DIR");
  app.add_option("--domain", typed.domain, "DDS domain (default 0)")
      ->type_name("N")
      ->check(CLI::Range(0, static_cast<int>(kMaxDomain)));
  app.add_option("--partition", typed.partition, "DDS partition (default: none)")
      ->type_name("NAME");
  app.add_flag("--no-publish", typed.no_publish, "do not publish over DDS");
  app.add_option(
         "--pace", typed.pace,
         "take a recording as it was captured, or as fast as possible (default: recorded, with "
         "--no-publish fastest)")
      ->type_name("recorded|fastest")
      ->check(CLI::IsMember(kPaceNames));
  app.add_flag("--print-config", typed.print_config, "print the effective configuration and end");
}

[[noreturn]] void wrong_usage(const std::string& cause, const std::string& remedy) {
  throw vision::InputError({"command line", 0, 0}, cause, remedy);
}

// The cameras that the options of one camera are for.
std::vector<CameraConfig*> addressed_cameras(const Typed& typed, TrackerConfig& config) {
  if (config.cameras.empty()) config.cameras.emplace_back().name = "cam0";
  if (config.cameras.size() == 1) {
    if (typed.camera) config.cameras[0].name = *typed.camera;
    return {&config.cameras[0]};
  }
  std::vector<CameraConfig*> cameras;
  for (CameraConfig& camera : config.cameras) {
    if (!typed.camera || camera.name == *typed.camera) cameras.push_back(&camera);
  }
  if (cameras.empty())
    wrong_usage("no camera has the name '" + *typed.camera + "'",
                "use a name of the configuration");
  if (cameras.size() > 1 && (typed.source || typed.calibration)) {
    wrong_usage("--source and --calibration are for one camera, and the configuration has several",
                "say which with --camera NAME");
  }
  return cameras;
}

void apply_to_camera(const Typed& typed, CameraConfig& camera) {
  if (typed.source) camera.source = *typed.source;
  if (typed.calibration) camera.calibration = *typed.calibration;
  if (!typed.layouts.empty()) camera.layouts.assign(typed.layouts.begin(), typed.layouts.end());
  if (typed.rate_hz) camera.rate_hz = *typed.rate_hz;
  if (typed.colours) camera.colours = *typed.colours;
  if (typed.mosaic) camera.mosaic = mosaic_from_name(*typed.mosaic);
  // A variance without a file takes the configuration's file away, a file without a variance is a
  // table.
  if (typed.variance || typed.noise) {
    camera.variance = typed.variance ? variance_from_name(*typed.variance) : VarianceModel::kTable;
    camera.noise = typed.noise.value_or("");
  }
}

TrackerConfig merged(const Typed& typed) {
  TrackerConfig config;
  if (!typed.config.empty()) config = load_tracker_config(typed.config);
  for (CameraConfig* camera : addressed_cameras(typed, config)) apply_to_camera(typed, *camera);
  if (typed.poses) config.poses = *typed.poses;
  if (typed.overlay) config.overlay = *typed.overlay;
  if (typed.domain) config.domain = *typed.domain;
  if (typed.partition) config.partition = *typed.partition;
  if (typed.no_publish) config.publish = false;
  if (typed.pace) config.pace = pace_from_name(*typed.pace);
  check(config, typed.config.empty() ? "command line" : typed.config);
  return config;
}

}  // namespace

CommandLine parse_command_line(int argc, char** argv) {
  CLI::App app(
      "Finds robots in the frames of cameras that look straight down and publishes their poses.",
      "nadir-tracker");
  app.failure_message(vision::usage_line);
  app.set_version_flag("--version", std::string("nadir-tracker ") + NADIR_VERSION);
  app.footer(kExample);
  Typed typed;
  add_camera_options(app, typed);
  add_run_options(app, typed);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return {.config = {}, .exit_code = app.exit(error) == 0 ? 0 : kWrongUsage};
  }
  CommandLine result{.config = merged(typed), .exit_code = std::nullopt};
  if (typed.print_config) {
    fmt::print("{}", to_yaml(result.config));
    result.exit_code = 0;
  }
  return result;
}

}  // namespace nadir::tracker
