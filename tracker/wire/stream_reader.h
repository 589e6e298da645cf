#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <string>
#include <utility>

#include "tracker/wire/bounded_queue.h"
#include "tracker/wire/dds_entities.h"
#include "tracker/wire/participant.h"
#include "tracker/wire/participant_state.h"
#include "tracker/wire/stream_status.h"

namespace nadir::tracker {

/// Where a stream is found on the network.
struct StreamPlace {
  const dds_topic_descriptor_t& type;
  const char* topic;
  DdsQos qos;
};

/// What the readers of all streams share: from Cyclone's receive thread into the queue or the
/// callback. `decode(const Sample&, Value*)` must be declared where this is used.
template <typename Sample, typename Value>
class StreamReader {
 public:
  using Wanted = std::function<bool(const Sample&)>;
  using Callback = std::function<void(const Value&)>;

  StreamReader(const Participant& participant, std::size_t queue_capacity, const StreamPlace& place,
               Wanted wanted, Callback callback)
      : wanted_(std::move(wanted)),
        callback_(std::move(callback)),
        queue_(queue_capacity),
        participant_(participant),
        topic_(make_topic(participant.state().entity, place.type, place.topic)) {
    const DdsListener listener(dds_create_listener(this));
    dds_lset_data_available(listener.get(), &StreamReader::on_data);
    dds_lset_liveliness_changed(listener.get(), &StreamReader::on_liveliness);
    reader_ = DdsEntity(dds_create_reader(participant.state().entity.handle(), topic_.handle(),
                                          place.qos.get(), listener.get()),
                        std::string("cannot read the DDS topic ") + place.topic);
  }
  StreamReader(const StreamReader&) = delete;  // DDS holds its address
  StreamReader& operator=(const StreamReader&) = delete;
  ~StreamReader() = default;

  bool poll(Value* value, std::chrono::nanoseconds timeout) { return queue_.pop(value, timeout); }
  ReaderStatus status() const;

 private:
  static constexpr std::uint32_t kTakeAtOnce = 8;

  static void on_data(dds_entity_t reader, void* self) {
    static_cast<StreamReader*>(self)->take_all(reader);
  }
  static void on_liveliness(dds_entity_t, dds_liveliness_changed_status_t status, void* self) {
    if (status.not_alive_count_change > 0) ++static_cast<StreamReader*>(self)->writers_lost_;
  }

  void take_all(dds_entity_t reader);
  void hand_over(const Sample& sample);

  Wanted wanted_;
  Callback callback_;
  Value scratch_;  ///< used on the receive thread only
  std::atomic<std::uint64_t> received_{0};
  std::atomic<std::uint64_t> malformed_{0};
  std::atomic<std::uint64_t> writers_lost_{0};
  BoundedQueue<Value> queue_;
  // Last, so that they go first: afterwards no listener runs any more.
  Participant participant_;
  DdsEntity topic_;
  DdsEntity reader_;
};

template <typename Sample, typename Value>
void StreamReader<Sample, Value>::take_all(dds_entity_t reader) {
  std::array<dds_sample_info_t, kTakeAtOnce> infos;
  dds_return_t count = kTakeAtOnce;
  while (count == static_cast<dds_return_t>(kTakeAtOnce)) {
    std::array<void*, kTakeAtOnce> samples{};  // null: DDS lends its own memory
    count = dds_take(reader, samples.data(), infos.data(), kTakeAtOnce, kTakeAtOnce);
    if (count <= 0) return;
    struct LoanGuard {
      dds_entity_t reader;
      void** samples;
      dds_return_t count;
      ~LoanGuard() { dds_return_loan(reader, samples, count); }
    } const guard{reader, samples.data(), count};
    for (dds_return_t i = 0; i < count; ++i) {
      if (infos[i].valid_data) hand_over(*static_cast<const Sample*>(samples[i]));
    }
  }
}

template <typename Sample, typename Value>
void StreamReader<Sample, Value>::hand_over(const Sample& sample) {
  if (!wanted_(sample)) return;
  if (!decode(sample, &scratch_)) {
    ++malformed_;
    return;
  }
  ++received_;
  if (callback_) {
    callback_(scratch_);
  } else {
    queue_.push(&scratch_);
  }
}

template <typename Sample, typename Value>
ReaderStatus StreamReader<Sample, Value>::status() const {
  ReaderStatus status;
  dds_subscription_matched_status_t matched{};
  if (dds_get_subscription_matched_status(reader_.handle(), &matched) == DDS_RETCODE_OK) {
    status.matched_writers = static_cast<int>(matched.current_count);
  }
  dds_liveliness_changed_status_t liveliness{};
  if (dds_get_liveliness_changed_status(reader_.handle(), &liveliness) == DDS_RETCODE_OK) {
    status.alive_writers = static_cast<int>(liveliness.alive_count);
  }
  dds_requested_deadline_missed_status_t deadline{};
  if (dds_get_requested_deadline_missed_status(reader_.handle(), &deadline) == DDS_RETCODE_OK) {
    status.deadlines_missed = deadline.total_count;
  }
  status.peers = participant_.peers();
  status.received = received_;
  status.dropped = queue_.dropped();
  status.malformed = malformed_;
  status.writers_lost = writers_lost_;
  return status;
}

}  // namespace nadir::tracker
