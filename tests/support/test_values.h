#pragma once

#include <cstdint>
#include <random>
#include <string>

#include "fusion/planar_pose.h"
#include "tracker/wire/client_state.h"
#include "tracker/wire/emergency_stop.h"
#include "tracker/wire/robot_io.h"
#include "tracker/wire/simulated_truth.h"

namespace nadir::test {

// Values of the robots' and clients' streams with another number in every field, computed from the
// arguments alone: two processes agree on them without talking.

tracker::WireWheelCommand test_command(std::uint64_t sequence, std::int32_t robot);
tracker::WireOdometry test_odometry(std::uint64_t sequence, std::int32_t robot);
tracker::WireClientState test_state(std::uint64_t sequence, std::int32_t robot);
tracker::WireEmergencyStop test_stop(std::int32_t robot);
tracker::WireSimulatedTruth test_truth(std::uint64_t sequence, std::int32_t robot);

/// Names of the fields in which the two differ; empty if they are equal to the last bit.
std::string difference(const tracker::WireWheelCommand& a, const tracker::WireWheelCommand& b);
std::string difference(const tracker::WireOdometry& a, const tracker::WireOdometry& b);
std::string difference(const tracker::WireClientState& a, const tracker::WireClientState& b);
std::string difference(const tracker::WireEmergencyStop& a, const tracker::WireEmergencyStop& b);
std::string difference(const tracker::WireSimulatedTruth& a, const tracker::WireSimulatedTruth& b);

}  // namespace nadir::test
