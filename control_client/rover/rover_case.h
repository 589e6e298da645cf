#pragma once

#include <cstdint>

#include "control_client/rover/rover_metrics.h"
#include "control_client/rover/rover_variant.h"

namespace nadir::control_client {

/// A variant, what its runs showed, and the first of them.
struct RoverCase {
  RoverVariant variant;
  RoverSummary summary;
  RoverRecord example;
};

/// Runs with the seeds from first_seed on, in a world where it looks as the variant does.
RoverCase run_rover_case(RoverWorld world, const RoverVariant& variant, std::uint64_t first_seed,
                         int runs);

}  // namespace nadir::control_client
