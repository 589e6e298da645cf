#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "control_client/differential/differential_cases.h"

namespace nadir::control_client {

/// What of an experiment is shown.
struct DifferentialLook {
  std::vector<std::string> drawn;  ///< names of the cases in the figure, four at most
  bool shows_overshoot = false;
};

/// A table for people.
std::string differential_text(const std::vector<DifferentialResult>& results,
                              const DifferentialLook& look);

/// All figures: metres, radians, seconds.
std::string differential_json(const std::string& experiment,
                              const std::vector<DifferentialResult>& results,
                              std::uint64_t first_seed);

/// The first run of some cases as one SVG that needs nothing else: paths, and the distance from the
/// reference over time.
std::string differential_figure(const std::vector<DifferentialResult>& results,
                                const DifferentialLook& look);

}  // namespace nadir::control_client
