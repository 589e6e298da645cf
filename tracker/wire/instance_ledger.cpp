#include "tracker/wire/instance_ledger.h"

#include <algorithm>

namespace nadir::tracker {

void InstanceLedger::touch(const WirePose& pose, std::int64_t now_ns) {
  // A field holds tens of robots: looking through them costs less than hashing their names.
  const auto same = std::find_if(instances_.begin(), instances_.end(), [&](const Instance& known) {
    return known.robot == pose.robot.robot && known.team == pose.robot.team &&
           known.camera == pose.camera;
  });
  if (same != instances_.end()) {
    same->last_ns = now_ns;
  } else {
    instances_.push_back({pose.robot.team, pose.camera, pose.robot.robot, now_ns});
  }
}

}  // namespace nadir::tracker
