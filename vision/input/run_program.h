#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "vision/input/input_error.h"

namespace nadir::vision {

/// Exit codes of every nadir program.
enum ExitCode { kDone = 0, kFailed = 1, kWrongInput = 2 };

/// Parses the command line and runs the job (also subcommands, while parsing). What is thrown
/// becomes one line on stderr, `nadir-fuse: file:line: cause; remedy`, and the exit code.
template <typename Job>
int run_program(CLI::App& app, int argc, char** argv, const Job& job) {
  try {
    app.parse(argc, argv);
    job();
    return kDone;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongInput;
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), error.what());
    return kWrongInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), error.what());
    return kFailed;
  }
}

}  // namespace nadir::vision
