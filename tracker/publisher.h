#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "tracker/pose_report.h"
#include "tracker/wire/pose_writer.h"
#include "tracker/wire/wire_types.h"

namespace nadir::tracker {

/// What a report says in the words of the wire, into samples that are used again. publish_ns is the
/// writer's.
void fill_pose(const FrameReport& report, const RobotReport& robot, std::uint64_t epoch,
               WirePose* pose);
void fill_frame(const FrameReport& report, std::uint64_t epoch, WireFrame* frame);

/// Puts frame reports on the network: first each robot's pose, as robots are waiting for theirs,
/// then the frame for monitors. Several cameras' threads may share one.
class Publisher {
 public:
  /// `epoch` tells one run of the tracker from the next: its start, ns since the Unix epoch.
  /// Throws WireError if DDS refuses.
  Publisher(const Participant& participant, std::uint64_t epoch);

  void publish(const FrameReport& report);
  PoseWriter::Status status() const;

 private:
  mutable std::mutex mutex_;
  std::uint64_t epoch_;
  PoseWriter writer_;
  std::vector<WirePose> poses_;  // as many as ever were needed at once
  WireFrame frame_;
};

}  // namespace nadir::tracker
