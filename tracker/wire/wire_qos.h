#pragma once

#include "tracker/wire/dds_entities.h"

namespace nadir::tracker {

/// The robots' stream. Writer and reader use the same, so they always agree.
///
/// Best effort: a pose that was lost is worth less than the next one, and resending delays that.
/// Keep the last 4, not 1: the onboard filter takes late poses in the order of capture, so a pose
/// that waits behind a busy receiver is information; beyond four frames the age, not the number, is
/// the problem. Liveliness by itself: the process lives, within kLivelinessLease. Deadline: the
/// robot is still seen.
DdsQos pose_qos(const WireOptions& options);

/// The monitors' stream: the same without a deadline, because cameras may pause.
DdsQos frame_qos(const WireOptions& options);

/// Commands of a client: reliable, and of each robot only the newest, because an older one is never
/// wanted. Liveliness by each writer itself: a client whose process lives but whose control loop
/// hangs counts as lost.
DdsQos command_qos(const WireOptions& options);

/// Odometry: like poses without a deadline, but deeper, because each sample is a piece of the way.
DdsQos odometry_qos(const WireOptions& options);

/// What a client says of itself: the newest is enough.
DdsQos client_state_qos(const WireOptions& options);

/// Emergency stops: reliable, and late joiners get what holds.
DdsQos emergency_stop_qos(const WireOptions& options);

/// Truth of simulated robots: like poses without a deadline.
DdsQos simulated_truth_qos(const WireOptions& options);

/// Questions and answers about clocks: what is lost is asked again. Deep enough for many clients
/// that ask at once.
DdsQos clock_qos(const WireOptions& options);

}  // namespace nadir::tracker
