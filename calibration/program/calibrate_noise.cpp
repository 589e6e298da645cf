// nadir-calibrate noise: how the error of marks depends on their pixel count, from recordings of
// robots that stand.

#include <iostream>
#include <memory>
#include <vector>

#include "calibration/noise/noise_from_law.h"
#include "calibration/noise/noise_from_log.h"
#include "calibration/noise/noise_from_standing.h"
#include "calibration/noise/noise_from_text.h"
#include "calibration/program/calibrate_commands.h"
#include "vision/disc_measurement.h"
#include "vision/input/input_error.h"
#include "vision/input/text_file.h"

namespace nadir::calibration {
namespace {

struct NoiseOptions {
  std::vector<std::string> poses;
  std::string output;
  std::string kind = "law";
  bool no_mosaic = false;
  std::string json;
};

/// "a.jsonl" or "a.jsonl and 2 more".
std::string names(const std::vector<std::string>& files) {
  if (files.size() == 1) return files.front();
  return files.front() + " and " + std::to_string(files.size() - 1) + " more";
}

void run(const NoiseOptions& options) {
  if (options.output == "-" && options.json == "-") {
    throw vision::InputError({}, "-o and --json both want stdout", "give one of them a file");
  }
  std::vector<LoggedTrack> tracks;
  for (const std::string& file : options.poses) {
    for (LoggedTrack& track : load_pose_tracks(file)) tracks.push_back(std::move(track));
  }
  NoiseLawSettings settings;
  settings.grid_variance_px2 =
      options.no_mosaic ? vision::kSamplingVariance_px2 : vision::kDemosaicedSamplingVariance_px2;
  settings.table = options.kind == "table";
  const StandingData data = find_standing(tracks);
  const NoiseFit fit = fit_noise(data, settings, names(options.poses));
  vision::write_text_file(options.output, noise_yaml(fit, names(options.poses)));
  if (!options.json.empty()) vision::write_text_file(options.json, noise_json(data, fit));
  std::cerr << noise_summary(data, fit);
}

}  // namespace

void add_noise_command(CLI::App& app) {
  const auto options = std::make_shared<NoiseOptions>();
  CLI::App* command = app.add_subcommand(
      "noise", "fits variance against pixel count to recordings of standing robots");
  command->add_option("poses", options->poses, "POSES.jsonl of nadir-tracker --poses, one or more")
      ->required();
  command->add_option("-o,--output", options->output, "noise file to write; - is stdout")
      ->required();
  command
      ->add_option("--kind", options->kind,
                   "law: 1 / pixel count; table: a variance per class of counts")
      ->check(CLI::IsMember({"law", "table"}))
      ->capture_default_str();
  command->add_flag("--no-mosaic", options->no_mosaic,
                    "the camera has all three colours in each pixel, so that its pixel grid, which "
                    "standing robots do not show, adds less");
  command->add_option("--json", options->json, "variances as JSON; - is stdout");
  command->footer(
      "Robots that move are recognised and left out; robots far and near, in good and bad light,\n"
      "tell most. Example: nadir-calibrate noise standing.jsonl -o noise.yaml");
  command->callback([options] { run(*options); });
}

}  // namespace nadir::calibration
