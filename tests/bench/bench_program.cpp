#include "tests/bench/bench_program.h"

#include <cstdio>
#include <exception>

namespace nadir::bench {

int bench_main(int argc, char** argv, CLI::App& app, const std::function<void()>& run) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    run();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), error.what());
    return 1;
  }
}

}  // namespace nadir::bench
