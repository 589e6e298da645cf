#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "tracker/wire/client_state.h"
#include "tracker/wire/emergency_stop.h"
#include "tracker/wire/participant.h"
#include "tracker/wire/robot_io.h"
#include "tracker/wire/simulated_truth.h"
#include "tracker/wire/stream_status.h"

namespace nadir::tracker {

/// Which robots a reader hears of; an empty field lets all pass. Of emergency stops those pass that
/// hold such a robot.
struct RobotFilter {
  std::optional<std::int32_t> robot;
  std::string team;
};

/// Writes one of the streams that carry a value for each robot. Thread-safe. Made for the value
/// types at the end of this file.
template <typename Value>
class ValueWriter {
 public:
  /// Throws WireError if DDS refuses.
  explicit ValueWriter(const Participant& participant);
  ValueWriter(ValueWriter&&) noexcept;
  ValueWriter& operator=(ValueWriter&&) noexcept;
  ~ValueWriter();

  /// Puts the value on the network; false, and counted, if it is impossible or DDS does not take
  /// it. Never throws. For wheel commands it is also the sign of life.
  bool write(const Value& value);

  /// Sign of life without a value, for the stream of wheel commands.
  void assert_alive();

  /// Reliable streams: waits until all readers have all values. False after the time-out. Who ends
  /// right after a value (an emergency stop) calls this first.
  bool wait_for_delivery(std::chrono::nanoseconds timeout);

  WriterStatus status() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Reads one of these streams, either through a queue (poll) or through a callback on the thread
/// that receives, which must only hand over.
template <typename Value>
class ValueReader {
 public:
  using Callback = std::function<void(const Value&)>;

  /// Values wait in a queue for poll(); a full one drops its oldest. Throws WireError if DDS
  /// refuses.
  explicit ValueReader(const Participant& participant, const RobotFilter& filter = {},
                       std::size_t queue_capacity = 64);
  /// Values do not go through the queue. Throws WireError if DDS refuses.
  ValueReader(const Participant& participant, const RobotFilter& filter, Callback on_value);
  ValueReader(ValueReader&&) noexcept;
  ValueReader& operator=(ValueReader&&) noexcept;
  ~ValueReader();

  /// Takes the oldest value in the queue; waits for one at most `timeout`. False if none came.
  bool poll(Value* value, std::chrono::nanoseconds timeout);

  ReaderStatus status() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

using WheelCommandWriter = ValueWriter<WireWheelCommand>;
using WheelCommandReader = ValueReader<WireWheelCommand>;
using OdometryWriter = ValueWriter<WireOdometry>;
using OdometryReader = ValueReader<WireOdometry>;
using ClientStateWriter = ValueWriter<WireClientState>;
using ClientStateReader = ValueReader<WireClientState>;
using EmergencyStopWriter = ValueWriter<WireEmergencyStop>;
using EmergencyStopReader = ValueReader<WireEmergencyStop>;
using SimulatedTruthWriter = ValueWriter<WireSimulatedTruth>;
using SimulatedTruthReader = ValueReader<WireSimulatedTruth>;

extern template class ValueWriter<WireWheelCommand>;
extern template class ValueReader<WireWheelCommand>;
extern template class ValueWriter<WireOdometry>;
extern template class ValueReader<WireOdometry>;
extern template class ValueWriter<WireClientState>;
extern template class ValueReader<WireClientState>;
extern template class ValueWriter<WireEmergencyStop>;
extern template class ValueReader<WireEmergencyStop>;
extern template class ValueWriter<WireSimulatedTruth>;
extern template class ValueReader<WireSimulatedTruth>;

}  // namespace nadir::tracker
