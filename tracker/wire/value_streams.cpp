#include "tracker/wire/value_streams.h"

#include <atomic>
#include <utility>

#include "tracker/wire/dds_entities.h"
#include "tracker/wire/participant_state.h"
#include "tracker/wire/stream_reader.h"
#include "tracker/wire/topics.h"
#include "tracker/wire/value_codec.h"
#include "tracker/wire/wire_qos.h"

namespace nadir::tracker {
namespace {

/// What a value type is called on the network, and where.
template <typename Value>
struct Stream;

template <>
struct Stream<WireWheelCommand> {
  using Sample = nadir_wire_WheelCommand;
  static StreamPlace place(const WireOptions& options) {
    return {nadir_wire_WheelCommand_desc, kWheelCommandTopic, command_qos(options)};
  }
};

template <>
struct Stream<WireOdometry> {
  using Sample = nadir_wire_Odometry;
  static StreamPlace place(const WireOptions& options) {
    return {nadir_wire_Odometry_desc, kOdometryTopic, odometry_qos(options)};
  }
};

template <>
struct Stream<WireClientState> {
  using Sample = nadir_wire_ClientState;
  static StreamPlace place(const WireOptions& options) {
    return {nadir_wire_ClientState_desc, kClientStateTopic, client_state_qos(options)};
  }
};

template <>
struct Stream<WireEmergencyStop> {
  using Sample = nadir_wire_EmergencyStop;
  static StreamPlace place(const WireOptions& options) {
    return {nadir_wire_EmergencyStop_desc, kEmergencyStopTopic, emergency_stop_qos(options)};
  }
};

template <>
struct Stream<WireSimulatedTruth> {
  using Sample = nadir_wire_SimulatedTruth;
  static StreamPlace place(const WireOptions& options) {
    return {nadir_wire_SimulatedTruth_desc, kSimulatedTruthTopic, simulated_truth_qos(options)};
  }
};

template <typename Sample>
bool passes(const RobotFilter& filter, const Sample& sample) {
  return (!filter.robot || *filter.robot == sample.robot) &&
         (filter.team.empty() || filter.team == sample.team);
}

// A stop without a team or a robot is for more than one.
bool passes(const RobotFilter& filter, const nadir_wire_EmergencyStop& sample) {
  const bool robot_passes = sample.everybody || !filter.robot || *filter.robot == sample.robot;
  const bool team_passes =
      sample.team[0] == '\0' || filter.team.empty() || filter.team == sample.team;
  return robot_passes && team_passes;
}

}  // namespace

template <typename Value>
struct ValueWriter<Value>::State {
  explicit State(const Participant& place) : State(place, Stream<Value>::place(place.options())) {}
  State(const Participant& place, const StreamPlace& stream)
      : participant(place),
        topic(make_topic(place.state().entity, stream.type, stream.topic)),
        writer(make_writer(place.state().entity, topic, stream.qos, stream.topic)) {}

  Participant participant;
  DdsEntity topic;
  DdsEntity writer;
  std::atomic<std::uint64_t> published{0};
  std::atomic<std::uint64_t> refused{0};
  std::atomic<std::uint64_t> failed{0};
};

template <typename Value>
ValueWriter<Value>::ValueWriter(const Participant& participant)
    : state_(std::make_unique<State>(participant)) {}
template <typename Value>
ValueWriter<Value>::ValueWriter(ValueWriter&&) noexcept = default;
template <typename Value>
ValueWriter<Value>& ValueWriter<Value>::operator=(ValueWriter&&) noexcept = default;
template <typename Value>
ValueWriter<Value>::~ValueWriter() = default;

template <typename Value>
bool ValueWriter<Value>::write(const Value& value) {
  typename Stream<Value>::Sample sample{};
  if (!encode(value, &sample)) {
    ++state_->refused;
    return false;
  }
  const bool written = dds_write(state_->writer.handle(), &sample) == DDS_RETCODE_OK;
  ++(written ? state_->published : state_->failed);
  return written;
}

template <typename Value>
void ValueWriter<Value>::assert_alive() {
  dds_assert_liveliness(state_->writer.handle());
}

template <typename Value>
bool ValueWriter<Value>::wait_for_delivery(std::chrono::nanoseconds timeout) {
  return dds_wait_for_acks(state_->writer.handle(), timeout.count()) == DDS_RETCODE_OK;
}

template <typename Value>
WriterStatus ValueWriter<Value>::status() const {
  return {.matched_readers = matched_readers(state_->writer),
          .published = state_->published,
          .refused = state_->refused,
          .failed = state_->failed};
}

template <typename Value>
struct ValueReader<Value>::State {
  using Sample = typename Stream<Value>::Sample;

  State(const Participant& participant, const RobotFilter& filter, std::size_t queue_capacity,
        Callback on_value)
      : stream(
            participant, queue_capacity, Stream<Value>::place(participant.options()),
            [filter](const Sample& sample) { return passes(filter, sample); },
            std::move(on_value)) {}

  StreamReader<Sample, Value> stream;
};

template <typename Value>
ValueReader<Value>::ValueReader(const Participant& participant, const RobotFilter& filter,
                                std::size_t queue_capacity)
    : state_(std::make_unique<State>(participant, filter, queue_capacity, nullptr)) {}
template <typename Value>
ValueReader<Value>::ValueReader(const Participant& participant, const RobotFilter& filter,
                                Callback on_value)
    : state_(std::make_unique<State>(participant, filter, 1, std::move(on_value))) {}
template <typename Value>
ValueReader<Value>::ValueReader(ValueReader&&) noexcept = default;
template <typename Value>
ValueReader<Value>& ValueReader<Value>::operator=(ValueReader&&) noexcept = default;
template <typename Value>
ValueReader<Value>::~ValueReader() = default;

template <typename Value>
bool ValueReader<Value>::poll(Value* value, std::chrono::nanoseconds timeout) {
  return state_->stream.poll(value, timeout);
}

template <typename Value>
ReaderStatus ValueReader<Value>::status() const {
  return state_->stream.status();
}

template class ValueWriter<WireWheelCommand>;
template class ValueReader<WireWheelCommand>;
template class ValueWriter<WireOdometry>;
template class ValueReader<WireOdometry>;
template class ValueWriter<WireClientState>;
template class ValueReader<WireClientState>;
template class ValueWriter<WireEmergencyStop>;
template class ValueReader<WireEmergencyStop>;
template class ValueWriter<WireSimulatedTruth>;
template class ValueReader<WireSimulatedTruth>;

}  // namespace nadir::tracker
