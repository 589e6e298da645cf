#pragma once

#include <CLI/CLI.hpp>
#include <atomic>

#include "control_client/drive/drive_command.h"
#include "control_client/drive/plot_command.h"
#include "control_client/drive/stop_command.h"
#include "control_client/drive/watch_command.h"
#include "control_client/experiment/experiment_command.h"

namespace nadir::control_client {

/// The command line of nadir-client: one subcommand for each thing that it can do.
class ClientCommands {
 public:
  /// Adds the subcommands to the program; outlives its parsing.
  explicit ClientCommands(CLI::App& app);

  /// Whether what was asked for goes on until it is told to end in good order.
  bool ends_on_signal() const { return drive_->parsed() || stop_->parsed() || watch_->parsed(); }

  /// Does what the parsed command line says, until it is done or `stop` is set. Throws
  /// vision::InputError for wrong input, std::exception where it fails.
  void run(const std::atomic<bool>& stop);

 private:
  void add_drive(CLI::App& app);
  void add_simulation(CLI::App& drive);
  void add_stop(CLI::App& app);
  void add_watch(CLI::App& app);
  void add_plot(CLI::App& app);
  void add_experiment(CLI::App& app);

  CLI::App* drive_ = nullptr;
  CLI::App* stop_ = nullptr;
  CLI::App* watch_ = nullptr;
  CLI::App* plot_ = nullptr;
  CLI::App* experiment_ = nullptr;
  DriveOptions drive_options_;
  StopOptions stop_options_;
  WatchOptions watch_options_;
  PlotOptions plot_options_;
  ExperimentOptions experiment_options_;
};

}  // namespace nadir::control_client
