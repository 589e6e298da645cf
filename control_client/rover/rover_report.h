#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "control_client/rover/rover_case.h"

namespace nadir::control_client {

/// A table for people, and below it whether the observers are stable, with their poles.
std::string rover_text(const std::vector<RoverCase>& cases);

/// All figures: metres, radians, seconds.
std::string rover_json(const std::vector<RoverCase>& cases, std::uint64_t first_seed);

/// The first run of some cases as one SVG that needs nothing else: paths among landmarks, and over
/// time the estimate's error and the heading that is to be kept.
std::string rover_figure(const RoverWorld& world, const std::vector<RoverCase>& cases);

}  // namespace nadir::control_client
