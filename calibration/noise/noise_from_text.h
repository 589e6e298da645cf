#pragma once

#include <string>

#include "calibration/noise/noise_from_law.h"

namespace nadir::calibration {

/// NOISE.yaml, as load_pixel_count_variance reads it, with comments on where it comes from.
std::string noise_yaml(const NoiseFit& fit, const std::string& origin);
/// Variances against pixel counts and the law through them, for a person. Lines, with an end of
/// line each.
std::string noise_summary(const StandingData& data, const NoiseFit& fit);
/// The same for a program: one JSON object.
std::string noise_json(const StandingData& data, const NoiseFit& fit);

}  // namespace nadir::calibration
