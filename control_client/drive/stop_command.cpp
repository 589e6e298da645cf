#include "control_client/drive/stop_command.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <thread>

#include "tracker/wire/clock_exchange.h"
#include "tracker/wire/value_streams.h"
#include "tracker/wire/wire_types.h"
#include "vision/input/input_error.h"

namespace nadir::control_client {
namespace {

using namespace std::chrono_literals;

tracker::WireEmergencyStop message_of(const StopOptions& options) {
  if (!options.robot && !options.team.empty()) {
    throw vision::InputError({"nadir-client", 0, 0}, "a stop is for one robot or for all",
                             "name --robot too, or leave --team out");
  }
  if (options.team.size() > tracker::kMaxTeamLength ||
      options.text.size() > tracker::kMaxWireText) {
    throw vision::InputError({"nadir-client", 0, 0}, "team or text is too long",
                             "15 and 79 bytes are the limits");
  }
  return {.everybody = !options.robot,
          .team = options.team,
          .robot = options.robot.value_or(0),
          .engaged = !options.releases,
          .stamp_ns = tracker::system_clock_ns(),
          .issuer = "nadir-client stop",
          .text = options.text};
}

std::string target_of(const StopOptions& options) {
  if (!options.robot) return "all robots";
  if (options.team.empty()) return fmt::format("robot {}", *options.robot);
  return fmt::format("{} {}", options.team, *options.robot);
}

void release(const StopOptions& options, tracker::EmergencyStopWriter& writer) {
  const auto patience = std::chrono::steady_clock::now() + 2s;
  while (writer.status().matched_readers == 0 && std::chrono::steady_clock::now() < patience) {
    std::this_thread::sleep_for(10ms);
  }
  std::this_thread::sleep_for(200ms);  // readers are found one after the other
  const int readers = writer.status().matched_readers;
  if (readers == 0) {
    throw std::runtime_error(fmt::format(
        "nobody listens on domain {}: no client and no stop to release", options.domain));
  }
  if (!writer.wait_for_delivery(2s)) throw std::runtime_error("not everybody heard the release");
  fmt::print(stderr, "released {}; {} heard it\n", target_of(options), readers);
}

/// Whether somebody else ends the stop that was engaged here.
bool releases(const tracker::WireEmergencyStop& heard, const tracker::WireEmergencyStop& mine) {
  if (heard.engaged) return false;
  return heard.everybody || (!mine.everybody && heard.robot == mine.robot &&
                             (heard.team == mine.team || heard.team.empty()));
}

}  // namespace

void run_stop_command(const StopOptions& options, const std::atomic<bool>& stop) {
  const tracker::WireEmergencyStop message = message_of(options);
  const tracker::Participant participant(
      {static_cast<std::uint32_t>(options.domain), options.partition});
  tracker::EmergencyStopWriter writer(participant);
  tracker::EmergencyStopReader reader(participant);
  writer.write(message);
  if (options.releases) {
    release(options, writer);
    return;
  }
  fmt::print(stderr,
             "stopped {}; this process stays, so that clients that come later hear of it.\n"
             "Ctrl-C ends it and releases nothing; nadir-client stop --release does\n",
             target_of(options));
  tracker::WireEmergencyStop heard;
  while (!stop.load()) {
    if (reader.poll(&heard, 50ms) && releases(heard, message)) {
      fmt::print(stderr, "released by {}\n", heard.issuer);
      return;
    }
  }
  writer.wait_for_delivery(1s);
}

}  // namespace nadir::control_client
