#include "tracker/wire/pose_reader.h"

#include "tracker/wire/pose_codec.h"
#include "tracker/wire/stream_reader.h"
#include "tracker/wire/topics.h"
#include "tracker/wire/wire_qos.h"

namespace nadir::tracker {
namespace {

bool matches(const std::string& wanted, const char* text) {
  return wanted.empty() || wanted == text;
}

}  // namespace

struct PoseReader::State {
  State(const Participant& participant, const ReaderOptions& options, Callback on_pose)
      : stream(
            participant, options.queue_capacity,
            {nadir_wire_RobotPose_desc, kRobotPoseTopic, pose_qos(participant.options())},
            [filter = options.filter](const nadir_wire_RobotPose& sample) {
              return (!filter.robot || *filter.robot == sample.robot) &&
                     matches(filter.team, sample.team) && matches(filter.camera, sample.camera);
            },
            std::move(on_pose)) {}

  StreamReader<nadir_wire_RobotPose, WirePose> stream;
};

PoseReader::PoseReader(const ReaderOptions& options) : PoseReader(options, nullptr) {}
PoseReader::PoseReader(const ReaderOptions& options, Callback on_pose)
    : PoseReader(Participant(options.wire), options, std::move(on_pose)) {}
PoseReader::PoseReader(const Participant& participant, const ReaderOptions& options)
    : PoseReader(participant, options, nullptr) {}
PoseReader::PoseReader(const Participant& participant, const ReaderOptions& options,
                       Callback on_pose)
    : state_(std::make_unique<State>(participant, options, std::move(on_pose))) {}
PoseReader::PoseReader(PoseReader&&) noexcept = default;
PoseReader& PoseReader::operator=(PoseReader&&) noexcept = default;
PoseReader::~PoseReader() = default;

bool PoseReader::poll(WirePose* pose, std::chrono::nanoseconds timeout) {
  return state_->stream.poll(pose, timeout);
}

ReaderStatus PoseReader::status() const { return state_->stream.status(); }

struct FrameReader::State {
  State(const Participant& participant, const ReaderOptions& options)
      : stream(
            participant, options.queue_capacity,
            {nadir_wire_FrameSummary_desc, kFrameTopic, frame_qos(participant.options())},
            [camera = options.filter.camera](const nadir_wire_FrameSummary& sample) {
              return matches(camera, sample.camera);
            },
            nullptr) {}

  StreamReader<nadir_wire_FrameSummary, WireFrame> stream;
};

FrameReader::FrameReader(const ReaderOptions& options)
    : FrameReader(Participant(options.wire), options) {}
FrameReader::FrameReader(const Participant& participant, const ReaderOptions& options)
    : state_(std::make_unique<State>(participant, options)) {}
FrameReader::FrameReader(FrameReader&&) noexcept = default;
FrameReader& FrameReader::operator=(FrameReader&&) noexcept = default;
FrameReader::~FrameReader() = default;

bool FrameReader::poll(WireFrame* frame, std::chrono::nanoseconds timeout) {
  return state_->stream.poll(frame, timeout);
}

ReaderStatus FrameReader::status() const { return state_->stream.status(); }

}  // namespace nadir::tracker
