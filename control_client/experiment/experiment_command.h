#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace nadir::control_client {

/// What `nadir-client experiment` was told.
struct ExperimentOptions {
  std::string name;
  std::string trajectory;  ///< name or file, for every case; empty: the experiment's own
  double speed = 1.0;      ///< factor on the speed of that trajectory
  std::string robot;       ///< ROBOT.yaml for every case; empty: omni3
  std::optional<int> runs;
  std::optional<std::uint64_t> first_seed;
  std::string json;  ///< empty: none
  std::string plot;  ///< empty: none
};

/// Runs an experiment and prints its table on standard output. Throws vision::InputError for an
/// unknown name, a wrong file, a trajectory that the robot cannot drive, and a file that cannot be
/// written.
void run_experiment_command(const ExperimentOptions& options, bool shows_progress);

/// `nadir-client list`: trajectories and experiments, a line each.
std::string list_text();

}  // namespace nadir::control_client
