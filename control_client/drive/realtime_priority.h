#pragma once

namespace nadir::control_client {

/// Puts the calling thread, and those that it starts from now on, before all ordinary ones of the
/// machine (SCHED_FIFO, priority 1 to 99; 0 changes nothing): a control loop that works for a tenth
/// of its time must not wait for those that compute all the time. False where the system does not
/// allow it; then all stays as it was.
bool take_realtime_priority(int priority);

}  // namespace nadir::control_client
