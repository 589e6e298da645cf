#include "tracker/wire/wire_qos.h"

namespace nadir::tracker {
namespace {

constexpr std::int32_t kDepth = 4;
constexpr std::int32_t kOdometryDepth = 8;
constexpr std::int32_t kClockDepth = 64;
constexpr std::chrono::milliseconds kLongestBlocking{10};  // of a control loop

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

DdsQos command_qos(const WireOptions& options) {
  DdsQos qos = stream_qos(options);
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, to_dds(kLongestBlocking));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
  dds_qset_liveliness(qos.get(), DDS_LIVELINESS_MANUAL_BY_TOPIC, to_dds(kLivelinessLease));
  return qos;
}

DdsQos odometry_qos(const WireOptions& options) {
  DdsQos qos = stream_qos(options);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, kOdometryDepth);
  return qos;
}

DdsQos client_state_qos(const WireOptions& options) {
  DdsQos qos = stream_qos(options);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
  return qos;
}

DdsQos emergency_stop_qos(const WireOptions& options) {
  DdsQos qos = stream_qos(options);
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, to_dds(kLongestBlocking));
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
  return qos;
}

DdsQos simulated_truth_qos(const WireOptions& options) { return stream_qos(options); }

DdsQos clock_qos(const WireOptions& options) {
  DdsQos qos = stream_qos(options);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, kClockDepth);
  return qos;
}

}  // namespace nadir::tracker
