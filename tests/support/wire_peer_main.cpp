// nadir-test-peer: one side of a robot's or client's stream, as the second process of tests.

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <thread>

#include "tests/support/test_values.h"
#include "tracker/wire/clock_exchange.h"
#include "tracker/wire/value_streams.h"

namespace {

using nadir::tracker::Participant;
using std::chrono::milliseconds;

volatile std::sig_atomic_t stop_requested = 0;

struct Options {
  std::string role;
  nadir::tracker::WireOptions wire;
  std::int32_t robots = 2;
  std::uint64_t values = 0;         // of each robot; 0: without end
  bool asserts_afterwards = false;  // stays alive after its last value; else only the process does
  bool everybody = false;
  bool release = false;
  double clock_error_s = 0.0;
  std::uint64_t epoch = 1;
};

void say(const char* words) {
  std::printf("%s\n", words);
  std::fflush(stdout);
}

/// Writes a value of each robot every 5 ms, waits until it is stopped.
template <typename Value>
void write_stream(const Options& options, Value (*make)(std::uint64_t, std::int32_t)) {
  const Participant participant(options.wire);
  nadir::tracker::ValueWriter<Value> writer(participant);
  say("writing");
  for (std::uint64_t k = 0; stop_requested == 0; ++k) {
    const bool over = options.values > 0 && k >= options.values;
    if (k == options.values && over) say("written");
    for (std::int32_t robot = 0; !over && robot < options.robots; ++robot) {
      writer.write(make(k, robot));
    }
    if (over && options.asserts_afterwards) writer.assert_alive();
    std::this_thread::sleep_for(milliseconds(5));
  }
}

void engage_stop(const Options& options) {
  const Participant participant(options.wire);
  nadir::tracker::EmergencyStopWriter writer(participant);
  nadir::tracker::WireEmergencyStop stop = nadir::test::test_stop(3);
  if (options.everybody) stop = {};
  stop.engaged = !options.release;
  if (options.release) {
    while (stop_requested == 0 && writer.status().matched_readers == 0) {
      std::this_thread::sleep_for(milliseconds(5));
    }
  }
  writer.write(stop);
  writer.wait_for_delivery(std::chrono::seconds(10));
  say("written");
  while (stop_requested == 0 && !options.release) std::this_thread::sleep_for(milliseconds(5));
}

void answer_clocks(const Options& options) {
  const Participant participant(options.wire);
  const auto error_ns = static_cast<std::int64_t>(options.clock_error_s * 1e9);
  const nadir::tracker::ClockAnswerer answerer(participant, options.epoch, [error_ns] {
    return nadir::tracker::system_clock_ns() + error_ns;
  });
  say("answering");
  while (stop_requested == 0) std::this_thread::sleep_for(milliseconds(5));
}

void run(const Options& options) {
  if (options.role == "commands") write_stream(options, nadir::test::test_command);
  if (options.role == "odometry") write_stream(options, nadir::test::test_odometry);
  if (options.role == "state") write_stream(options, nadir::test::test_state);
  if (options.role == "truth") write_stream(options, nadir::test::test_truth);
  if (options.role == "stop") engage_stop(options);
  if (options.role == "clock") answer_clocks(options);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Speaks one of the robots' and clients' streams.");
  app.add_option("role", options.role)
      ->required()
      ->check(CLI::IsMember({"commands", "odometry", "state", "truth", "stop", "clock"}));
  app.add_option("--domain", options.wire.domain);
  app.add_option("--robots", options.robots);
  app.add_option("--values", options.values);
  app.add_flag("--assert-afterwards", options.asserts_afterwards);
  app.add_flag("--everybody", options.everybody);
  app.add_flag("--release", options.release);
  app.add_option("--clock-error", options.clock_error_s);
  app.add_option("--epoch", options.epoch);
  CLI11_PARSE(app, argc, argv);
  std::signal(SIGTERM, [](int) { stop_requested = 1; });
  try {
    run(options);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "nadir-test-peer: %s\n", error.what());
    return 1;
  }
}
