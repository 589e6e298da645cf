#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "control_client/experiment/experiment_command.h"
#include "vision/input/input_error.h"
#include "vision/input/usage_line.h"

namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongInput = 2;

void add_experiment(CLI::App& app, nadir::control_client::ExperimentOptions& options) {
  CLI::App* experiment = app.add_subcommand(
      "experiment", "closed loop with the simulated robot, in one process and simulated time");
  experiment->add_option("name", options.name, "experiment, see nadir-client list")->required();
  experiment
      ->add_option("--runs", options.runs, "seeds of each case; the experiment's own if absent")
      ->check(CLI::Range(1, 100000));
  experiment->add_option("--seed", options.first_seed,
                         "first seed of the runs; the experiment's own if absent");
  experiment->add_option("--trajectory", options.trajectory, "in place of the experiment's own")
      ->type_name("NAME|FILE");
  experiment->add_option("--speed", options.speed, "factor on the speed of --trajectory")
      ->check(CLI::Range(0.01, 100.0));
  experiment->add_option("--robot", options.robot, "in place of data/robots/omni3.yaml")
      ->type_name("ROBOT.yaml");
  experiment->add_option("--json", options.json, "write all figures to this file")
      ->type_name("FILE");
  experiment->add_option("--plot", options.plot, "draw the first runs' paths to this file")
      ->type_name("FILE.svg");
}

}  // namespace

int main(int argc, char** argv) {
  nadir::control_client::ExperimentOptions options;
  CLI::App app("The process on the robot: experiments with the simulated one.", "nadir-client");
  app.footer("Example: nadir-client experiment e2 --runs 10 --plot square.svg");
  app.failure_message(nadir::vision::usage_line);
  app.set_version_flag("--version", "nadir-client " NADIR_VERSION);
  app.require_subcommand(1);
  add_experiment(app, options);
  app.add_subcommand("list", "trajectories and experiments, a line each");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongInput;
  }
  try {
    if (app.got_subcommand("list")) {
      fmt::print("{}", nadir::control_client::list_text());
    } else {
      nadir::control_client::run_experiment_command(options, isatty(STDERR_FILENO) != 0);
    }
    return kDone;
  } catch (const nadir::vision::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kWrongInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "nadir-client: {}\n", error.what());
    return kFailed;
  }
}
