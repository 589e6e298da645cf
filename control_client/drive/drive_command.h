#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace nadir::control_client {

/// What `nadir-client drive` was told on the command line; it wins over the configuration.
struct DriveOptions {
  std::int32_t robot = 0;
  std::string trajectory;
  std::string config;  ///< DRIVE.yaml; empty: the defaults
  std::optional<int> domain;
  std::optional<std::string> partition;
  std::optional<std::string> team;
  std::string robot_file;
  std::string robot_type;  ///< empty: what the robot's file says
  std::optional<double> speed;
  bool fits_limits = false;
  bool repeats = false;
  std::vector<double> place;  ///< x m, y m, heading deg; empty: the configuration's
  std::vector<double> start;  ///< of the simulated robot, the same
  bool simulates = false;
  std::optional<int> seed;
  std::optional<double> clock_error_s;
  std::optional<double> duration_s;
  std::string log;
  bool prints_config = false;
};

/// Drives. Throws vision::InputError for wrong files, an unknown trajectory or one that the robot
/// cannot drive, std::exception for everything else.
void run_drive_command(const DriveOptions& options, const std::atomic<bool>& stop);

}  // namespace nadir::control_client
