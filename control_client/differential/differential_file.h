#pragma once

#include <filesystem>
#include <string>

#include "control_client/differential/tracking_controller.h"

namespace nadir::control_client {

/// A robot with two driven wheels, as data/robots/differential.yaml says it.
struct DifferentialParameters {
  std::string name = "differential";
  double track_m = 0.3;  ///< distance of the wheels
  UnicycleLimits limits{0.4, 0.8, true};
  double wheel_lag_s = 0.05;  ///< time constant in which a wheel reaches its speed
  TrackingWeights weights{1.0, 50.0, 1.0};
  double tick_s = 0.02;
};

/// Reads ROBOT.yaml strictly; every key but `type` has the default above. Throws
/// vision::InputError: unknown or duplicate key, value out of range, another type.
DifferentialParameters load_differential_parameters(const std::filesystem::path& file);

}  // namespace nadir::control_client
