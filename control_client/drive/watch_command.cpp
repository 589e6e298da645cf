#include "control_client/drive/watch_command.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>

#include "control_client/drive/client_watch.h"
#include "tracker/wire/clock_exchange.h"
#include "tracker/wire/value_streams.h"

namespace nadir::control_client {

void run_watch_command(const WatchOptions& options, bool is_terminal,
                       const std::atomic<bool>& stop) {
  using Clock = std::chrono::steady_clock;
  using namespace std::chrono_literals;
  constexpr std::size_t kTruths = 4096;  // of many robots, in one turn
  const tracker::Participant participant(
      {static_cast<std::uint32_t>(options.domain), options.partition});
  tracker::ClientStateReader states(participant, {}, 256);
  tracker::SimulatedTruthReader truths(participant, {}, kTruths);
  ClientWatch watch;
  const auto started = Clock::now();
  auto next_line = started;
  const Clock::duration pause = is_terminal ? 200ms : 1000ms;
  while (!stop.load() &&
         (!options.duration_s ||
          Clock::now() - started < std::chrono::duration<double>(*options.duration_s))) {
    tracker::WireClientState state;
    tracker::WireSimulatedTruth truth;
    if (states.poll(&state, 50ms)) watch.add(state);
    while (states.poll(&state, 0ns)) watch.add(state);
    while (truths.poll(&truth, 0ns)) watch.add(truth);
    if (Clock::now() < next_line) continue;
    const std::string line = watch.line(tracker::system_clock_ns());
    if (line.empty()) continue;
    next_line = Clock::now() + pause;
    fmt::print("{}{}{}", is_terminal ? "\r\033[K" : "", line, is_terminal ? "" : "\n");
    std::fflush(stdout);
  }
  if (is_terminal) fmt::print("\n");
}

}  // namespace nadir::control_client
