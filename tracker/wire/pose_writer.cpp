#include "tracker/wire/pose_writer.h"

#include "tracker/wire/dds_entities.h"
#include "tracker/wire/instance_ledger.h"
#include "tracker/wire/participant_state.h"
#include "tracker/wire/pose_codec.h"
#include "tracker/wire/topics.h"
#include "tracker/wire/wire_qos.h"

namespace nadir::tracker {
namespace {

template <typename Clock>
std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch())
      .count();
}

/// Cyclone DDS takes this switch over from the process when a writer is made: on for this one only.
class BatchingOn {
 public:
  BatchingOn() { dds_write_set_batch(true); }
  BatchingOn(const BatchingOn&) = delete;
  BatchingOn& operator=(const BatchingOn&) = delete;
  ~BatchingOn() { dds_write_set_batch(false); }
};

DdsEntity make_batching_writer(const DdsEntity& participant, const DdsEntity& topic,
                               const DdsQos& qos, const char* name) {
  const BatchingOn batching;
  return make_writer(participant, topic, qos, name);
}

/// Poses go out in datagrams of so many: fewer system calls, and less waiting for the last robot.
/// Not more, because a datagram must stay below an Ethernet frame (1472 bytes): in pieces, the loss
/// of one piece is the loss of all. The largest pose, with the longest names and eight markers,
/// takes 292 bytes with its headers.
constexpr std::size_t kPosesInDatagram = 4;

}  // namespace

struct PoseWriter::State {
  explicit State(const Participant& place)
      : participant(place),
        pose_topic(make_topic(entity(), nadir_wire_RobotPose_desc, kRobotPoseTopic)),
        frame_topic(make_topic(entity(), nadir_wire_FrameSummary_desc, kFrameTopic)),
        pose_writer(
            make_batching_writer(entity(), pose_topic, pose_qos(place.options()), kRobotPoseTopic)),
        frame_writer(make_writer(entity(), frame_topic, frame_qos(place.options()), kFrameTopic)) {
    frame_robots.reserve(kMaxRobotsInFrame);
  }

  const DdsEntity& entity() const { return participant.state().entity; }
  void count(dds_return_t written, std::uint64_t* published) {
    ++(written == DDS_RETCODE_OK ? *published : counters.failed);
  }
  void write(const nadir_wire_RobotPose& sample) {
    count(dds_write(pose_writer.handle(), &sample), &counters.published_poses);
  }
  void flush() { dds_write_flush(pose_writer.handle()); }

  /// Notes who was published, and takes off the network who was not for too long.
  void keep_ledger(std::span<const WirePose> poses, std::int64_t steady_ns);

  Participant participant;
  DdsEntity pose_topic;
  DdsEntity frame_topic;
  DdsEntity pose_writer;
  DdsEntity frame_writer;
  InstanceLedger ledger;
  std::vector<nadir_wire_FrameRobot> frame_robots;
  Status counters;
};

void PoseWriter::State::keep_ledger(std::span<const WirePose> poses, std::int64_t steady_ns) {
  for (const WirePose& pose : poses) ledger.touch(pose, steady_ns);
  constexpr std::chrono::nanoseconds kRetirement = kInstanceRetirement;
  bool retired = false;
  ledger.retire_older(steady_ns - kRetirement.count(), [&](const InstanceLedger::Instance& gone) {
    WirePose key;
    key.robot.team = gone.team;
    key.robot.robot = gone.robot;
    key.camera = gone.camera;
    nadir_wire_RobotPose sample{};
    // A pose that was refused is in the ledger too, but not on the network: nothing is lost if this
    // fails.
    if (encode(key, &sample)) dds_unregister_instance(pose_writer.handle(), &sample);
    retired = true;
  });
  if (retired) flush();
}

PoseWriter::PoseWriter(const WireOptions& options) : PoseWriter(Participant(options)) {}
PoseWriter::PoseWriter(const Participant& participant)
    : state_(std::make_unique<State>(participant)) {}
PoseWriter::PoseWriter(PoseWriter&&) noexcept = default;
PoseWriter& PoseWriter::operator=(PoseWriter&&) noexcept = default;
PoseWriter::~PoseWriter() = default;

void PoseWriter::publish(std::span<const WirePose> poses) {
  const std::int64_t publish_ns = now_ns<std::chrono::system_clock>();
  const std::int64_t steady_ns = now_ns<std::chrono::steady_clock>();
  std::size_t waiting = 0;
  for (const WirePose& pose : poses) {
    nadir_wire_RobotPose sample{};
    if (!encode(pose, &sample)) {
      ++state_->counters.refused;
      continue;
    }
    sample.publish_ns = publish_ns;
    state_->write(sample);
    if (++waiting % kPosesInDatagram == 0) state_->flush();
  }
  if (waiting % kPosesInDatagram != 0) state_->flush();
  state_->keep_ledger(poses, steady_ns);
}

void PoseWriter::publish(const WireFrame& frame) {
  nadir_wire_FrameSummary sample{};
  if (!encode(frame, &state_->frame_robots, &sample)) {
    ++state_->counters.refused;
    return;
  }
  sample.publish_ns = now_ns<std::chrono::system_clock>();
  state_->count(dds_write(state_->frame_writer.handle(), &sample),
                &state_->counters.published_frames);
}

PoseWriter::Status PoseWriter::status() const {
  Status status = state_->counters;
  status.matched_pose_readers = matched_readers(state_->pose_writer);
  status.matched_frame_readers = matched_readers(state_->frame_writer);
  return status;
}

}  // namespace nadir::tracker
