#include "tracker/wire/emergency_stop.h"

#include <algorithm>

namespace nadir::tracker {

void EmergencyStops::apply(const WireEmergencyStop& stop) {
  std::erase_if(engaged_, [&stop](const WireEmergencyStop& known) {
    const bool same_target =
        known.everybody == stop.everybody && known.team == stop.team && known.robot == stop.robot;
    return same_target || (stop.everybody && !stop.engaged);
  });
  if (stop.engaged) engaged_.push_back(stop);
}

const WireEmergencyStop* EmergencyStops::engaged(const std::string& team,
                                                 std::int32_t robot) const {
  const auto holds = [&](const WireEmergencyStop& stop) {
    return stop.everybody || (stop.robot == robot && (stop.team.empty() || stop.team == team));
  };
  const auto found = std::ranges::find_if(engaged_, holds);
  return found == engaged_.end() ? nullptr : &*found;
}

}  // namespace nadir::tracker
