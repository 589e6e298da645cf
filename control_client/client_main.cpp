// nadir-client: the process on the robot, and what belongs to it.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>

#include "control_client/client_commands.h"
#include "vision/input/input_error.h"
#include "vision/input/usage_line.h"

namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongInput = 2;

std::atomic<bool> g_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // so that a signal may set it

extern "C" void stop_on_signal(int /*signal*/) { g_stop = true; }

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("The process on the robot: drives it, or a simulated one.", "nadir-client");
  app.footer(
      "Example: nadir-client drive --robot 3 --trajectory circle --simulate --log circle.csv\n"
      "         nadir-client experiment e2 --runs 10 --plot square.svg");
  app.failure_message(nadir::vision::usage_line);
  app.set_version_flag("--version", "nadir-client " NADIR_VERSION);
  nadir::control_client::ClientCommands commands(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongInput;
  }
  try {
    if (commands.ends_on_signal()) {
      std::signal(SIGINT, stop_on_signal);
      std::signal(SIGTERM, stop_on_signal);
    }
    commands.run(g_stop);
    return kDone;
  } catch (const nadir::vision::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kWrongInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "nadir-client: {}\n", error.what());
    return kFailed;
  }
}
