#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace nadir::tracker {

inline constexpr std::size_t kMaxWireIssuer = 31;  ///< bytes

/// From anybody to all clients: stop, or stop no longer. The key is its target.
///
/// The network keeps it for clients that come later, but only as long as the writer lives that
/// wrote it: who engages a stop stays until it is released.
struct WireEmergencyStop {
  bool everybody = true;   ///< all robots; then team is empty and robot 0
  std::string team;        ///< at most kMaxTeamLength bytes; empty: this number in all teams
  std::int32_t robot = 0;  ///< the one robot
  bool engaged = true;     ///< false: released
  std::int64_t stamp_ns = 0;
  std::string issuer;  ///< who says so, at most kMaxWireIssuer bytes
  std::string text;    ///< why, at most kMaxWireText bytes
};

/// What all stops that have arrived say together. The newest arrival of each target counts,
/// whatever its stamp: clocks differ, and a stop must work at once. A release for everybody
/// releases each single robot, too.
class EmergencyStops {
 public:
  void apply(const WireEmergencyStop& stop);

  /// The stop that holds this robot, or null: a pointer into this object, valid until apply().
  const WireEmergencyStop* engaged(const std::string& team, std::int32_t robot) const;

 private:
  std::vector<WireEmergencyStop> engaged_;
};

}  // namespace nadir::tracker
