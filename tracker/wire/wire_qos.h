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

}  // namespace nadir::tracker
