#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>

#include "tracker/wire/client_state.h"
#include "tracker/wire/simulated_truth.h"

namespace nadir::control_client {

/// All clients of a domain in one line: what each does, and how far its estimate is from the truth
/// where a simulation tells it, or its robot from the trajectory where none does.
class ClientWatch {
 public:
  void add(const tracker::WireClientState& state);
  void add(const tracker::WireSimulatedTruth& truth);

  /// "blue 3 driving 0.6 mm 0.12 deg | blue 5 stopped (no odometry)"; clients that were silent for
  /// more than 2 s are left out, `now_ns` is this machine's wall clock.
  std::string line(std::int64_t now_ns) const;

 private:
  struct Client {
    tracker::WireClientState state;
    std::int64_t heard_ns = 0;
    std::deque<tracker::WireSimulatedTruth> truth;  // the last half second
  };
  using Key = std::pair<std::string, std::int32_t>;

  static std::string errors(const Client& client);

  std::map<Key, Client> clients_;
};

}  // namespace nadir::control_client
