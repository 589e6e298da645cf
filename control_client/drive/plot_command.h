#pragma once

#include <string>
#include <vector>

namespace nadir::control_client {

/// What `nadir-client plot` was told.
struct PlotOptions {
  std::vector<std::string> logs;
  std::string svg;   ///< empty: none
  std::string json;  ///< empty: none
};

/// Prints a table of errors of logged drives and draws them. Throws vision::InputError for what is
/// no log, std::runtime_error for a file that cannot be written.
void run_plot_command(const PlotOptions& options);

}  // namespace nadir::control_client
