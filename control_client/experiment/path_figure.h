#pragma once

#include <string>

#include "control_client/experiment/experiment_runner.h"

namespace nadir::control_client {

/// The paths of an experiment's first seed as one SVG that needs nothing else, in millimetres. A
/// block for each of the first conditions: side by side one panel for each driver, with the
/// commanded, the true and the estimated path and the frames that were used or rejected, and below
/// them the distance from the nominal motion over time.
std::string path_figure(const ExperimentResult& result);

}  // namespace nadir::control_client
