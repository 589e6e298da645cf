#pragma once

#include <memory>

#include "tracker/wire/wire_options.h"

namespace nadir::tracker {

/// The place of a process on the network: one DDS participant, shared by the writers and readers
/// that are made with it. Each participant costs every other one discovery traffic and a few
/// threads, so a process needs one. Copies share it; it leaves the network with the last of them.
class Participant {
 public:
  /// Throws WireError for a domain beyond kMaxDomain, or if DDS refuses.
  explicit Participant(const WireOptions& options);

  const WireOptions& options() const;
  /// Other participants of the domain that discovery knows of; -1 if DDS does not say.
  int peers() const;

  /// For writers and readers of this room.
  struct State;
  const State& state() const { return *state_; }

 private:
  std::shared_ptr<const State> state_;
};

}  // namespace nadir::tracker
