#pragma once

#include "nadir_client.h"  // these four are written by idlc
#include "nadir_robot.h"
#include "nadir_stop.h"
#include "nadir_truth.h"
#include "tracker/wire/client_state.h"
#include "tracker/wire/emergency_stop.h"
#include "tracker/wire/robot_io.h"
#include "tracker/wire/simulated_truth.h"

namespace nadir::tracker {

// Between the value types of the robots' and clients' streams and what idlc generates. Both ways
// refuse what does not belong on the wire and return false: text beyond its bound, numbers that are
// not finite or beyond what a robot can do, a heading outside (-pi, pi], a negative variance, an
// interval that ends before it begins, an unknown kind or mode.

bool encode(const WireWheelCommand& command, nadir_wire_WheelCommand* sample);
bool decode(const nadir_wire_WheelCommand& sample, WireWheelCommand* command);

bool encode(const WireOdometry& odometry, nadir_wire_Odometry* sample);
bool decode(const nadir_wire_Odometry& sample, WireOdometry* odometry);

bool encode(const WireClientState& state, nadir_wire_ClientState* sample);
bool decode(const nadir_wire_ClientState& sample, WireClientState* state);

bool encode(const WireEmergencyStop& stop, nadir_wire_EmergencyStop* sample);
bool decode(const nadir_wire_EmergencyStop& sample, WireEmergencyStop* stop);

bool encode(const WireSimulatedTruth& truth, nadir_wire_SimulatedTruth* sample);
bool decode(const nadir_wire_SimulatedTruth& sample, WireSimulatedTruth* truth);

}  // namespace nadir::tracker
