#include "tracker/wire/wire_qos.h"

namespace nadir::tracker {
namespace {

constexpr std::int32_t kDepth = 4;

dds_duration_t to_dds(std::chrono::nanoseconds duration) { return duration.count(); }

DdsQos stream_qos(const WireOptions& options) {
  DdsQos qos(dds_create_qos());
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, kDepth);
  dds_qset_liveliness(qos.get(), DDS_LIVELINESS_AUTOMATIC, to_dds(kLivelinessLease));
  if (!options.partition.empty()) dds_qset_partition1(qos.get(), options.partition.c_str());
  return qos;
}

}  // namespace

DdsQos pose_qos(const WireOptions& options) {
  DdsQos qos = stream_qos(options);
  dds_qset_deadline(qos.get(), to_dds(kPoseDeadline));
  return qos;
}

DdsQos frame_qos(const WireOptions& options) { return stream_qos(options); }

}  // namespace nadir::tracker
