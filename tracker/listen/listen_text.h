#pragma once

#include <cstdint>
#include <string>

#include "tracker/wire/client_state.h"
#include "tracker/wire/wire_types.h"

namespace nadir::tracker {

// How nadir-listen prints what it receives: one line each, without the line's end. now_ns is the
// time of printing since the Unix epoch; the age that is shown is now_ns - capture_ns.

/// Names over the columns of pose_columns.
std::string pose_columns_header();
/// Pose, 1-sigma of each coordinate and the upper triangle of the covariance, in columns.
std::string pose_columns(const WirePose& pose, std::int64_t now_ns);
/// One JSON object: the fields of a robot in the poses file, and camera, epoch, frame, times and
/// age_ms.
std::string pose_json(const WirePose& pose, std::int64_t now_ns);

std::string frame_columns_header();
std::string frame_columns(const WireFrame& frame, std::int64_t now_ns);
/// One JSON object like a line of the poses file; `rejected` is the number of rejected candidates.
std::string frame_json(const WireFrame& frame, std::int64_t now_ns);

std::string client_columns_header();
/// Mode, reason, estimate, its error to the trajectory in mm and mrad, counts, clock and text, in
/// columns.
std::string client_columns(const WireClientState& state, std::int64_t now_ns);
/// One JSON object with every field of the state, and age_ms (wrong by the client's clock).
std::string client_json(const WireClientState& state, std::int64_t now_ns);

}  // namespace nadir::tracker
