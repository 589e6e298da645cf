#pragma once

#include <optional>

#include "tracker/tracker_config.h"

namespace nadir::tracker {

/// What nadir-tracker shall do, or the exit code with which it is done already (--help, --version,
/// --print-config, wrong usage). What the command line says wins over the file of --config. Throws
/// InputError on a bad file.
struct CommandLine {
  TrackerConfig config;
  std::optional<int> exit_code;
};

CommandLine parse_command_line(int argc, char** argv);

}  // namespace nadir::tracker
