#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

namespace nadir::control_client {

/// What `nadir-client stop` was told.
struct StopOptions {
  std::optional<std::int32_t> robot;  ///< nothing: all robots
  std::string team;                   ///< empty: that number in all teams
  bool releases = false;
  std::string text;  ///< why
  int domain = 0;
  std::string partition;
};

/// Engages an emergency stop and stays until somebody releases it or `stop` is set, for the network
/// keeps it for late clients only as long as this process lives; or releases one and ends. Clients
/// that heard of a stop stand until it is released, whoever engaged it. Throws std::runtime_error
/// if a release reached nobody, InputError for an impossible target.
void run_stop_command(const StopOptions& options, const std::atomic<bool>& stop);

}  // namespace nadir::control_client
