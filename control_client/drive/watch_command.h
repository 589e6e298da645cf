#pragma once

#include <atomic>
#include <optional>
#include <string>

namespace nadir::control_client {

/// What `nadir-client watch` was told.
struct WatchOptions {
  int domain = 0;
  std::string partition;
  std::optional<double> duration_s;  ///< nothing: until it is interrupted
};

/// Shows all clients in one line: it renews itself on a terminal, and comes every second elsewhere.
void run_watch_command(const WatchOptions& options, bool is_terminal,
                       const std::atomic<bool>& stop);

}  // namespace nadir::control_client
