#include "control_client/experiment/experiment_command.h"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "control_client/experiment/experiment_report.h"
#include "control_client/experiment/experiment_runner.h"
#include "control_client/experiment/path_figure.h"
#include "control_client/trajectory.h"
#include "vision/input/input_error.h"

namespace nadir::control_client {
namespace {

const Experiment& experiment_of(const std::string& name) {
  if (const Experiment* found = find_experiment(name)) return *found;
  std::string names;
  for (const Experiment& each : experiments()) names += (names.empty() ? "" : ", ") + each.name;
  throw vision::InputError({"nadir-client", 0, 0}, "no experiment is called '" + name + "'",
                           "choose one of " + names);
}

void write_text(const std::string& text, const std::string& file) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error("cannot write " + file);
}

}  // namespace

void run_experiment_command(const ExperimentOptions& options, bool shows_progress) {
  const Experiment& experiment = experiment_of(options.name);
  const ExperimentResult result =
      run_experiment(experiment, options.first_seed.value_or(experiment.first_seed),
                     options.runs.value_or(experiment.runs), [&](std::size_t done) {
                       if (!shows_progress) return;
                       fmt::print(stderr, "\r{} of {} cases{}", done, experiment.cases.size(),
                                  done == experiment.cases.size() ? "\n" : "");
                     });
  fmt::print("{}", text_report(result));
  if (!options.json.empty()) write_text(json_report(result).dump(2) + "\n", options.json);
  if (!options.plot.empty()) write_text(path_figure(result), options.plot);
}

std::string list_text() {
  std::string text;
  const auto out = std::back_inserter(text);
  for (const NamedTrajectory& each : standard_trajectories()) {
    fmt::format_to(out, "trajectory  {:<16} {}\n", each.name, each.description);
  }
  for (const Experiment& each : experiments()) {
    fmt::format_to(out, "experiment  {:<16} {}\n", each.name, each.description);
  }
  return text;
}

}  // namespace nadir::control_client
