// nadir-client: the process on the robot, and experiments with the simulated one.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>

#include "control_client/drive/drive_command.h"
#include "control_client/experiment/experiment_command.h"
#include "tracker/wire/wire_options.h"
#include "vision/input/input_error.h"
#include "vision/input/usage_line.h"

namespace {

using nadir::control_client::DriveOptions;
using nadir::control_client::ExperimentOptions;

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongInput = 2;

std::atomic<bool> g_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // so that a signal may set it

extern "C" void stop_on_signal(int /*signal*/) { g_stop = true; }

CLI::App* add_experiment(CLI::App& app, ExperimentOptions& options) {
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
  return experiment;
}

void add_network(CLI::App& app, std::optional<int>& domain, std::optional<std::string>& partition) {
  app.add_option("--domain", domain, "DDS domain, 0 by default")
      ->check(CLI::Range(0, static_cast<int>(nadir::tracker::kMaxDomain)));
  app.add_option("--partition", partition, "part of the domain")->type_name("NAME");
}

CLI::App* add_drive(CLI::App& app, DriveOptions& options) {
  CLI::App* drive =
      app.add_subcommand("drive", "poses from the tracker, fusion, controller, wheel commands");
  drive->add_option("--robot", options.robot, "number of the robot")->required();
  drive->add_option("--team", options.team, "its team, blue by default");
  drive->add_option("--trajectory", options.trajectory, "see nadir-client list")
      ->type_name("NAME|FILE");
  drive->add_option("--config", options.config, "everything else, see data/clients")
      ->type_name("DRIVE.yaml");
  drive->add_flag("--print-config", options.prints_config, "print what is in force, and end");
  add_network(*drive, options.domain, options.partition);
  drive->add_option("--robot-file", options.robot_file, "body, wheels and gains; omni3 by default")
      ->type_name("ROBOT.yaml");
  drive->add_option("--speed", options.speed, "factor on the speed of the trajectory")
      ->check(CLI::Range(0.01, 100.0));
  drive->add_flag("--fit", options.fits_limits, "slower where the robot could not follow");
  drive->add_option("--place", options.place, "put the trajectory there: x m, y m, heading deg")
      ->delimiter(',')
      ->expected(3);
  drive->add_flag("--repeat", options.repeats, "again and again");
  drive->add_option("--duration", options.duration_s, "again until this time is over, s")
      ->check(CLI::Range(0.1, 1e7));
  drive->add_flag("--simulate", options.simulates,
                  "with a simulated robot instead of one on the network");
  drive->add_option("--start", options.start, "of the simulated robot: x m, y m, heading deg")
      ->delimiter(',')
      ->expected(3);
  drive->add_option("--seed", options.seed, "of the simulated wheels")
      ->check(CLI::Range(0, 2000000000));
  drive->add_option("--clock-error", options.clock_error_s, "make the robot's clock wrong, s");
  drive->add_option("--log", options.log, "write a row for each tick")->type_name("FILE.csv");
  return drive;
}

}  // namespace

int main(int argc, char** argv) {
  ExperimentOptions experiment_options;
  DriveOptions drive_options;
  CLI::App app("The process on the robot: drives it, or a simulated one.", "nadir-client");
  app.footer(
      "Example: nadir-client drive --robot 3 --trajectory circle --simulate --log circle.csv\n"
      "         nadir-client experiment e2 --runs 10 --plot square.svg");
  app.failure_message(nadir::vision::usage_line);
  app.set_version_flag("--version", "nadir-client " NADIR_VERSION);
  app.require_subcommand(1);
  const CLI::App* drive = add_drive(app, drive_options);
  const CLI::App* experiment = add_experiment(app, experiment_options);
  app.add_subcommand("list", "trajectories and experiments, a line each");
  try {
    app.parse(argc, argv);
    if (drive->parsed() && drive_options.trajectory.empty() && !drive_options.prints_config) {
      throw CLI::RequiredError("--trajectory");
    }
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongInput;
  }
  std::signal(SIGINT, stop_on_signal);
  std::signal(SIGTERM, stop_on_signal);
  try {
    if (drive->parsed()) {
      nadir::control_client::run_drive_command(drive_options, g_stop);
    } else if (experiment->parsed()) {
      nadir::control_client::run_experiment_command(experiment_options, isatty(STDERR_FILENO) != 0);
    } else {
      fmt::print("{}", nadir::control_client::list_text());
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
