#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>

namespace nadir::vision {

/// Wrong usage in one line, `nadir-listen: cause; see nadir-listen --help`, as every nadir program
/// says it:
///
///     app.failure_message(usage_line);
inline std::string usage_line(const CLI::App* app, const CLI::Error& error) {
  std::string cause = error.what();
  std::replace(cause.begin(), cause.end(), '\n', ' ');
  return app->get_name() + ": " + cause + "; see " + app->get_name() + " --help\n";
}

}  // namespace nadir::vision
