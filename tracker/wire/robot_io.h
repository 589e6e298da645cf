#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace nadir::tracker {

// Between a client and the base of its robot. Team and robot are the key of each; nadir_robot.idl
// states the same bounds.

inline constexpr std::size_t kMaxWireWheels = 6;

// No robot of ours is beyond these: they catch wrong units and broken arithmetic.
inline constexpr double kMaxWireSpeed_mps = 100.0;
inline constexpr double kMaxWireTurn_radps = 1000.0;
inline constexpr double kMaxWireVoltage_v = 1000.0;
inline constexpr std::int64_t kMaxWireInterval_ns = 10'000'000'000;

/// How a robot moves in its own frame: forward, to the left, counter-clockwise.
struct WireBodyRates {
  double u_mps = 0.0;
  double v_mps = 0.0;
  double r_radps = 0.0;
};

/// One number for each wheel, in the order of the robot's description.
struct WireWheels {
  std::array<double, kMaxWireWheels> values{};
  std::size_t count = 0;
};

/// What the `wheels` of a command hold.
enum class WheelCommandKind : std::uint8_t {
  kBodyRates = 0,  ///< nothing: the base turns the body rates into wheel speeds itself
  kRimSpeeds = 1,  ///< m/s at the rims
  kVolts = 2,      ///< motor volts
};

/// Client to robot base.
struct WireWheelCommand {
  std::string team;  ///< at most kMaxTeamLength bytes
  std::int32_t robot = 0;
  std::uint64_t epoch = 0;  ///< one run of a client: sequence numbers start anew with it
  std::uint64_t sequence = 0;
  std::int64_t stamp_ns = 0;      ///< client's clock
  std::int64_t valid_for_ns = 0;  ///< above 0, at most kMaxWireInterval_ns: without a newer command
                                  ///< for this long after its arrival the base stops by itself
  WheelCommandKind kind = WheelCommandKind::kBodyRates;
  WireWheels wheels;         ///< m/s or V, as `kind` says; at least one unless kBodyRates
  WireBodyRates body_rates;  ///< that the client wants
};

/// What an odometry sample holds.
enum class OdometryKind : std::uint8_t {
  kBodyRates = 1,  ///< mean body rates over the interval
  kRimTravel = 2,  ///< metres that each wheel's rim went, from encoder increments
};

/// Robot base to client.
struct WireOdometry {
  std::string team;  ///< at most kMaxTeamLength bytes
  std::int32_t robot = 0;
  std::uint64_t epoch = 0;  ///< one run of a robot base
  std::uint64_t sequence = 0;
  std::int64_t t_from_ns = 0;  ///< the interval that was measured, in the robot's clock
  std::int64_t t_to_ns = 0;    ///< after t_from_ns, by at most kMaxWireInterval_ns
  OdometryKind kind = OdometryKind::kBodyRates;
  WireBodyRates body_rates;  ///< with kBodyRates
  WireWheels travel_m;       ///< with kRimTravel: at least one
};

}  // namespace nadir::tracker
