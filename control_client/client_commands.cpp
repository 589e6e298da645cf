#include "control_client/client_commands.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "tracker/wire/wire_options.h"

namespace nadir::control_client {
namespace {

template <class Domain, class Partition>
void add_network(CLI::App& app, Domain& domain, Partition& partition) {
  app.add_option("--domain", domain, "DDS domain, 0 by default")
      ->check(CLI::Range(0, static_cast<int>(tracker::kMaxDomain)));
  app.add_option("--partition", partition, "part of the domain")->type_name("NAME");
}

}  // namespace

ClientCommands::ClientCommands(CLI::App& app) {
  app.require_subcommand(1);
  add_drive(app);
  add_stop(app);
  add_watch(app);
  add_plot(app);
  add_experiment(app);
  app.add_subcommand("list", "trajectories and experiments, a line each");
}

void ClientCommands::add_drive(CLI::App& app) {
  DriveOptions& options = drive_options_;
  drive_ =
      app.add_subcommand("drive", "poses from the tracker, fusion, controller, wheel commands");
  drive_->add_option("--robot", options.robot, "number of the robot")->required();
  drive_->add_option("--team", options.team, "its team, blue by default");
  auto* trajectory = drive_->add_option("--trajectory", options.trajectory, "see nadir-client list")
                         ->type_name("NAME|FILE");
  drive_->add_option("--config", options.config, "everything else, see data/clients")
      ->type_name("DRIVE.yaml");
  drive_->add_flag("--print-config", options.prints_config, "print what is in force, and end");
  add_network(*drive_, options.domain, options.partition);
  drive_->add_option("--robot-file", options.robot_file, "body, wheels and gains; omni3 by default")
      ->type_name("ROBOT.yaml");
  drive_
      ->add_option("--robot-type", options.robot_type,
                   "omnidirectional, differential or rover; what the robot's file says by default")
      ->type_name("TYPE");
  drive_->add_option("--speed", options.speed, "factor on the speed of the trajectory")
      ->check(CLI::Range(0.01, 100.0));
  drive_->add_flag("--fit", options.fits_limits, "slower where the robot could not follow");
  drive_->add_option("--place", options.place, "put the trajectory there: x m, y m, heading deg")
      ->type_name("X,Y,DEG")
      ->delimiter(',')
      ->expected(3);
  drive_->add_flag("--repeat", options.repeats, "the trajectory again and again");
  drive_->add_option("--duration", options.duration_s, "again until this time is over, s")
      ->check(CLI::Range(0.1, 1e7));
  drive_->add_option("--clock-error", options.clock_error_s, "make the robot's clock wrong, s");
  drive_->add_option("--log", options.log, "write a row for each tick")->type_name("FILE.csv");
  add_simulation(*drive_);
  drive_->final_callback([this, trajectory] {
    if (trajectory->empty() && !drive_options_.prints_config) {
      throw CLI::RequiredError("--trajectory");
    }
  });
}

void ClientCommands::add_simulation(CLI::App& drive) {
  DriveOptions& options = drive_options_;
  auto* simulate = drive.add_flag("--simulate", options.simulates,
                                  "with a simulated robot instead of one on the network");
  drive.add_option("--start", options.start, "of the simulated robot: x m, y m, heading deg")
      ->type_name("X,Y,DEG")
      ->delimiter(',')
      ->expected(3)
      ->needs(simulate);
  drive.add_option("--seed", options.seed, "of the simulated wheels")
      ->check(CLI::Range(0, 2000000000))
      ->needs(simulate);
}

void ClientCommands::add_stop(CLI::App& app) {
  StopOptions& options = stop_options_;
  stop_ = app.add_subcommand("stop", "emergency stop of one robot or of all");
  stop_->add_option("--robot", options.robot, "only this one");
  stop_->add_option("--team", options.team, "only of this team, with --robot");
  stop_->add_flag("--release", options.releases, "the robots may drive again");
  stop_->add_option("--text", options.text, "why");
  add_network(*stop_, options.domain, options.partition);
}

void ClientCommands::add_watch(CLI::App& app) {
  watch_ = app.add_subcommand("watch", "what all clients do and how large their errors are, live");
  watch_->add_option("--duration", watch_options_.duration_s, "end after this time, s")
      ->check(CLI::Range(0.1, 1e7));
  add_network(*watch_, watch_options_.domain, watch_options_.partition);
}

void ClientCommands::add_plot(CLI::App& app) {
  plot_ = app.add_subcommand("plot", "errors and picture of logged drives with simulated robots");
  plot_->add_option("logs", plot_options_.logs, "written by drive --log")
      ->type_name("LOG.csv")
      ->required();
  plot_->add_option("-o", plot_options_.svg, "draw the paths to this file")->type_name("FILE.svg");
  plot_->add_option("--json", plot_options_.json, "write the errors to this file")
      ->type_name("FILE");
}

void ClientCommands::add_experiment(CLI::App& app) {
  ExperimentOptions& options = experiment_options_;
  experiment_ = app.add_subcommand(
      "experiment", "closed loop with the simulated robot, in one process and simulated time");
  experiment_->add_option("name", options.name, "experiment, see nadir-client list")->required();
  experiment_
      ->add_option("--runs", options.runs, "seeds of each case; the experiment's own if absent")
      ->check(CLI::Range(1, 100000));
  experiment_->add_option("--seed", options.first_seed,
                          "first seed of the runs; the experiment's own if absent");
  experiment_->add_option("--trajectory", options.trajectory, "in place of the experiment's own")
      ->type_name("NAME|FILE");
  experiment_->add_option("--speed", options.speed, "factor on the speed of --trajectory")
      ->check(CLI::Range(0.01, 100.0));
  experiment_->add_option("--robot", options.robot, "in place of data/robots/omni3.yaml")
      ->type_name("ROBOT.yaml");
  experiment_->add_option("--json", options.json, "write all figures to this file")
      ->type_name("FILE");
  experiment_->add_option("--plot", options.plot, "draw the first runs' paths to this file")
      ->type_name("FILE.svg");
}

void ClientCommands::run(const std::atomic<bool>& stop) {
  if (drive_->parsed()) {
    run_drive_command(drive_options_, stop);
  } else if (stop_->parsed()) {
    run_stop_command(stop_options_, stop);
  } else if (watch_->parsed()) {
    run_watch_command(watch_options_, isatty(STDOUT_FILENO) != 0, stop);
  } else if (plot_->parsed()) {
    run_plot_command(plot_options_);
  } else if (experiment_->parsed()) {
    run_experiment_command(experiment_options_, isatty(STDERR_FILENO) != 0);
  } else {
    fmt::print("{}", list_text());
  }
}

}  // namespace nadir::control_client
