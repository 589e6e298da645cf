#include "control_client/rover/rover_case.h"

#include <utility>
#include <vector>

namespace nadir::control_client {

RoverCase run_rover_case(RoverWorld world, const RoverVariant& variant, std::uint64_t first_seed,
                         int runs) {
  world.looks_first = variant.looks_first;
  std::vector<RoverRecord> records;
  records.reserve(static_cast<std::size_t>(runs));
  for (int run = 0; run < runs; ++run) {
    records.push_back(
        run_rover(world, variant.settings, first_seed + static_cast<std::uint64_t>(run)));
  }
  RoverCase result{variant, summarize(world, records), {}};
  if (!records.empty()) result.example = std::move(records.front());
  return result;
}

}  // namespace nadir::control_client
