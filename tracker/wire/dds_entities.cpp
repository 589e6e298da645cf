#include "tracker/wire/dds_entities.h"

#include <array>
#include <utility>

namespace nadir::tracker {

DdsEntity::DdsEntity(dds_entity_t handle_or_error, const std::string& what)
    : handle_(handle_or_error) {
  if (handle_or_error < 0) {
    handle_ = 0;
    throw WireError(what + ": " + dds_strretcode(handle_or_error) +
                    " (is CYCLONEDDS_URI a valid configuration, and is a network interface up?)");
  }
}

DdsEntity::DdsEntity(DdsEntity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}

DdsEntity& DdsEntity::operator=(DdsEntity&& other) noexcept {
  std::swap(handle_, other.handle_);
  return *this;
}

DdsEntity::~DdsEntity() {
  if (handle_ > 0) dds_delete(handle_);
}

DdsEntity make_participant(const WireOptions& options) {
  if (options.domain > kMaxDomain) {
    throw WireError("DDS domain " + std::to_string(options.domain) +
                    " is not usable: choose 0 to " + std::to_string(kMaxDomain));
  }
  return {dds_create_participant(options.domain, nullptr, nullptr),
          "cannot join DDS domain " + std::to_string(options.domain)};
}

DdsEntity make_topic(const DdsEntity& participant, const dds_topic_descriptor_t& type,
                     const char* name) {
  return {dds_create_topic(participant.handle(), &type, name, nullptr, nullptr),
          std::string("cannot create the DDS topic ") + name};
}

DdsEntity make_writer(const DdsEntity& participant, const DdsEntity& topic, const DdsQos& qos,
                      const char* name) {
  return {dds_create_writer(participant.handle(), topic.handle(), qos.get(), nullptr),
          std::string("cannot write the DDS topic ") + name};
}

int matched_readers(const DdsEntity& writer) {
  dds_publication_matched_status_t matched{};
  return dds_get_publication_matched_status(writer.handle(), &matched) == DDS_RETCODE_OK
             ? static_cast<int>(matched.current_count)
             : 0;
}

int count_peers(const DdsEntity& participant) {
  const dds_entity_t reader =
      dds_create_reader(participant.handle(), DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr);
  if (reader < 0) return -1;
  const DdsEntity owner(reader, "reader of the participants");
  constexpr int kMaxListed = 256;
  std::array<void*, kMaxListed> samples{};
  std::array<dds_sample_info_t, kMaxListed> infos;
  const dds_return_t count =
      dds_read(reader, samples.data(), infos.data(), samples.size(), kMaxListed);
  if (count < 0) return -1;
  int alive = 0;
  for (int i = 0; i < count; ++i) {
    if (infos[i].valid_data && infos[i].instance_state == DDS_ALIVE_INSTANCE_STATE) ++alive;
  }
  dds_return_loan(reader, samples.data(), count);
  return alive - 1;  // without ourselves
}

}  // namespace nadir::tracker
