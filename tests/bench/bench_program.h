#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace nadir::bench {

/// The body of a benchmark's main: reads the command line into what `app`'s options are bound to,
/// then runs. Returns the exit status: 0 done, 1 and a line on stderr if `run` throws, 2 wrong
/// usage.
int bench_main(int argc, char** argv, CLI::App& app, const std::function<void()>& run);

}  // namespace nadir::bench
