#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "control_client/experiment/experiment_runner.h"

namespace nadir::control_client {

/// A table for people: a line for each case and estimator, millimetres and degrees.
std::string text_report(const ExperimentResult& result);

/// All figures, in metres, radians and seconds.
nlohmann::json json_report(const ExperimentResult& result);

}  // namespace nadir::control_client
