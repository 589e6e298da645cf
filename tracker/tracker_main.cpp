// nadir-tracker: frames in, identified poses with covariance out.

#include <atomic>
#include <csignal>
#include <exception>
#include <string>

#include "tracker/command_line.h"
#include "tracker/console.h"
#include "tracker/tracker_server.h"
#include "vision/input/input_error.h"

namespace {

std::atomic<bool> g_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // so that a signal may set it

extern "C" void stop_on_signal(int /*signal*/) { g_stop = true; }

}  // namespace

int main(int argc, char** argv) {
  nadir::tracker::Console console;
  try {
    const nadir::tracker::CommandLine command = nadir::tracker::parse_command_line(argc, argv);
    if (command.exit_code) return *command.exit_code;
    std::signal(SIGINT, stop_on_signal);
    std::signal(SIGTERM, stop_on_signal);
    nadir::tracker::TrackerServer server(command.config, console);
    return server.run(g_stop);
  } catch (const nadir::vision::InputError& error) {
    console.line(std::string("nadir-tracker: ") + error.what());
    return 2;
  } catch (const std::exception& error) {
    console.line(std::string("nadir-tracker: ") + error.what());
    return 1;
  }
}
