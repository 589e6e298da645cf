#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <memory>
#include <string>

#include "tracker/wire/wire_options.h"

namespace nadir::tracker {

/// Owns one DDS entity; deleting a participant deletes its children too. Move-only.
class DdsEntity {
 public:
  DdsEntity() = default;
  /// Takes over what a dds_create_... function returned. Throws WireError, naming `what`, if that
  /// is an error code.
  DdsEntity(dds_entity_t handle_or_error, const std::string& what);
  DdsEntity(DdsEntity&& other) noexcept;
  DdsEntity& operator=(DdsEntity&& other) noexcept;
  DdsEntity(const DdsEntity&) = delete;
  DdsEntity& operator=(const DdsEntity&) = delete;
  ~DdsEntity();

  dds_entity_t handle() const { return handle_; }

 private:
  dds_entity_t handle_ = 0;
};

struct QosDeleter {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using DdsQos = std::unique_ptr<dds_qos_t, QosDeleter>;

struct ListenerDeleter {
  void operator()(dds_listener_t* listener) const { dds_delete_listener(listener); }
};
using DdsListener = std::unique_ptr<dds_listener_t, ListenerDeleter>;

/// Participant in the domain of the options. Throws WireError for a domain beyond kMaxDomain, or if
/// DDS refuses.
DdsEntity make_participant(const WireOptions& options);

/// Throws WireError, naming the topic, if DDS refuses.
DdsEntity make_topic(const DdsEntity& participant, const dds_topic_descriptor_t& type,
                     const char* name);

/// Throws WireError, naming the topic, if DDS refuses.
DdsEntity make_writer(const DdsEntity& participant, const DdsEntity& topic, const DdsQos& qos,
                      const char* name);

/// Readers that a writer has found and that fit it.
int matched_readers(const DdsEntity& writer);

/// Other participants of the domain that discovery knows of; -1 if DDS does not say.
int count_peers(const DdsEntity& participant);

}  // namespace nadir::tracker
