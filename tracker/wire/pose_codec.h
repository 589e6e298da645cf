#pragma once

#include <vector>

#include "nadir.h"  // written by idlc from nadir.idl
#include "tracker/wire/wire_types.h"

namespace nadir::tracker {

// Between the value types and what idlc generates. Both ways refuse what does not belong on the
// wire and return false: text or lists beyond their bounds, numbers that are not finite, a heading
// outside (-pi, pi], a negative variance, a confidence outside [0, 1].

/// Fills `sample`, except publish_ns. It borrows the pose's pixel counts: write it before the pose
/// changes.
bool encode(const WirePose& pose, nadir_wire_RobotPose* sample);

/// Fills `sample`, except publish_ns. It borrows the frame's pixel counts, and `storage` for its
/// robots.
bool encode(const WireFrame& frame, std::vector<nadir_wire_FrameRobot>* storage,
            nadir_wire_FrameSummary* sample);

bool decode(const nadir_wire_RobotPose& sample, WirePose* pose);
bool decode(const nadir_wire_FrameSummary& sample, WireFrame* frame);

}  // namespace nadir::tracker
