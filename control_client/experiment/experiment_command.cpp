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
#include "control_client/robot_file.h"
#include "control_client/trajectory.h"
#include "control_client/trajectory_file.h"
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

/// The experiment with the robot and the trajectory of the command line.
Experiment adapted(Experiment experiment, const ExperimentOptions& options) {
  if (!options.robot.empty()) {
    const RobotConfig config = load_robot(options.robot);
    for (ExperimentCase& each : experiment.cases) {
      each.scenario.robot = config.robot;
      each.scenario.control = config.control;
    }
  }
  if (!options.trajectory.empty()) {
    for (ExperimentCase& each : experiment.cases) {
      each.scenario.trajectory =
          choose_trajectory(options.trajectory, RobotModel(each.scenario.robot), options.speed);
      each.label = options.trajectory + (each.label.empty() ? "" : " in place of " + each.label);
    }
  }
  return experiment;
}

void write_text(const std::string& text, const std::string& file) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error("cannot write " + file);
}

}  // namespace

void run_experiment_command(const ExperimentOptions& options, bool shows_progress) {
  const Experiment experiment = adapted(experiment_of(options.name), options);
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
