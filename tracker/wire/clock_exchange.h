#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>

#include "tracker/wire/participant.h"
#include "tracker/wire/stream_status.h"

namespace nadir::tracker {

/// Nanoseconds since the Unix epoch of some process' wall clock.
using WallClock = std::function<std::int64_t()>;

/// This machine's wall clock.
std::int64_t system_clock_ns();

/// One question of a client and a tracker's answer, four time stamps: the offset is known but for
/// the difference between the two ways, which is at most the round trip.
struct ClockExchange {
  std::uint64_t epoch = 0;  ///< the tracker's run, as in its poses
  std::uint64_t sequence = 0;
  std::int64_t t1_ns = 0;  ///< client asks, client's clock
  std::int64_t t2_ns = 0;  ///< tracker receives, tracker's clock
  std::int64_t t3_ns = 0;  ///< tracker answers, tracker's clock
  std::int64_t t4_ns = 0;  ///< client receives, client's clock

  /// Tracker's clock minus the client's: ((t2 - t1) + (t3 - t4)) / 2. Its error is at most half the
  /// round trip.
  std::int64_t offset_ns() const { return (t2_ns - t1_ns + (t3_ns - t4_ns)) / 2; }
  /// Time on the network, both ways.
  std::int64_t round_trip_ns() const { return t4_ns - t1_ns - (t3_ns - t2_ns); }
};

/// The client's side.
class ClockAsker {
 public:
  /// client: one run of a client, different from all others. clock: the client's; asked also on the
  /// thread that receives. Throws WireError if DDS refuses.
  ClockAsker(const Participant& participant, std::uint64_t client, WallClock clock);
  ClockAsker(ClockAsker&&) noexcept;
  ClockAsker& operator=(ClockAsker&&) noexcept;
  ~ClockAsker();

  /// Asks all trackers. Call it a few times a second, from one thread.
  void ask();
  /// Takes the oldest answer; waits for one at most `timeout`. False if none came. With several
  /// trackers `epoch` tells whose it is.
  bool poll(ClockExchange* exchange, std::chrono::nanoseconds timeout);

  /// Of the answers.
  ReaderStatus status() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The tracker's side: answers by itself, in a thread of its own, so that neither poses nor the
/// thread that receives wait for it.
class ClockAnswerer {
 public:
  struct Status {
    std::uint64_t answered = 0;
    std::uint64_t dropped = 0;    ///< questions that came too fast
    std::uint64_t malformed = 0;  ///< questions that the codec refused
    std::uint64_t failed = 0;     ///< answers that DDS did not take
  };

  /// epoch: that of the tracker's poses. Throws WireError if DDS refuses.
  ClockAnswerer(const Participant& participant, std::uint64_t epoch,
                WallClock clock = system_clock_ns);
  ClockAnswerer(ClockAnswerer&&) noexcept;
  ClockAnswerer& operator=(ClockAnswerer&&) noexcept;
  ~ClockAnswerer();

  Status status() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nadir::tracker
