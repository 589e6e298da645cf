#pragma once

#include <string>
#include <vector>

#include "control_client/drive/drive_log_reader.h"

namespace nadir::control_client {

/// The paths of drives side by side as one SVG that needs nothing else: commanded, true, estimated,
/// and where the encoders alone would lead; below each the distance of both estimates from the
/// truth over time, and below all a table of errors. Up to four drives.
std::string drive_figure(const std::vector<DriveRecord>& drives);

}  // namespace nadir::control_client
