#include "control_client/experiment/experiment_command.h"

#include <fmt/format.h>

#include <cstdio>
#include <iterator>
#include <nlohmann/json.hpp>

#include "control_client/experiment/experiment_report.h"
#include "control_client/experiment/experiment_runner.h"
#include "control_client/experiment/path_figure.h"
#include "control_client/experiment/study_catalogue.h"
#include "control_client/robot_file.h"
#include "control_client/trajectory.h"
#include "control_client/trajectory_file.h"
#include "vision/input/input_error.h"
#include "vision/input/text_file.h"

namespace nadir::control_client {
namespace {

const Experiment& experiment_of(const std::string& name) {
  if (const Experiment* found = find_experiment(name)) return *found;
  std::string names;
  for (const Experiment& each : experiments()) names += (names.empty() ? "" : ", ") + each.name;
  for (const Study& each : studies()) names += ", " + each.name;
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

void write_results(const StudyResult& result, const ExperimentOptions& options) {
  fmt::print("{}", result.text);
  if (!options.json.empty()) vision::write_text_file(options.json, result.json);
  if (!options.plot.empty()) vision::write_text_file(options.plot, result.svg);
}

void show_progress(std::size_t done, std::size_t cases) {
  fmt::print(stderr, "\r{} of {} cases{}", done, cases, done == cases ? "\n" : "");
}

void run_study(const Study& study, const ExperimentOptions& options, bool shows_progress) {
  if (!options.robot.empty() || !options.trajectory.empty()) {
    throw vision::InputError({"nadir-client", 0, 0},
                             study.name + " has a robot and trajectories of its own",
                             "leave --robot and --trajectory away");
  }
  StudyRuns runs{
      options.first_seed.value_or(study.first_seed), options.runs.value_or(study.runs), {}};
  if (shows_progress) runs.progress = show_progress;
  write_results(study.run(runs), options);
}

}  // namespace

void run_experiment_command(const ExperimentOptions& options, bool shows_progress) {
  if (const Study* study = find_study(options.name)) {
    run_study(*study, options, shows_progress);
    return;
  }
  const Experiment experiment = adapted(experiment_of(options.name), options);
  const ExperimentResult result =
      run_experiment(experiment, options.first_seed.value_or(experiment.first_seed),
                     options.runs.value_or(experiment.runs), [&](std::size_t done) {
                       if (shows_progress) show_progress(done, experiment.cases.size());
                     });
  write_results({text_report(result), json_report(result).dump(2) + "\n",
                 options.plot.empty() ? "" : path_figure(result)},
                options);
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
  for (const Study& each : studies()) {
    fmt::format_to(out, "experiment  {:<16} {}\n", each.name, each.description);
  }
  return text;
}

}  // namespace nadir::control_client
