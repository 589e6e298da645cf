#include "tracker/pipeline_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "calibration/calibration_height.h"
#include "vision/input/input_error.h"

namespace nadir::tracker {
namespace {

void check_team_names(const std::vector<vision::MarkerLayout>& layouts) {
  for (std::size_t i = 0; i < layouts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (const vision::Team& team : layouts[i].teams) {
        for (const vision::Team& other : layouts[j].teams) {
          if (team.name != other.name) continue;
          throw vision::InputError(
              {layouts[i].name, 0, 0},
              fmt::format("layouts '{}' and '{}' both have a team '{}'", layouts[j].name,
                          layouts[i].name, team.name),
              "give one of the teams another name: robots are told apart by team and number");
        }
      }
    }
  }
}

}  // namespace

PipelineSetup checked(PipelineSetup setup, int width_px, int height_px) {
  calibration::check_image_size(setup.calibration, setup.calibration_file, width_px, height_px);
  check_team_names(setup.layouts);
  std::stable_partition(setup.layouts.begin(), setup.layouts.end(),
                        [](const vision::MarkerLayout& layout) { return !layout.tags; });
  return setup;
}

std::vector<calibration::PlaneMap> maps_of(const PipelineSetup& setup) {
  std::vector<calibration::PlaneMap> maps;
  for (const vision::MarkerLayout& layout : setup.layouts) {
    maps.push_back(calibration::map_at_height(setup.calibration, layout.height_m));
  }
  return maps;
}

}  // namespace nadir::tracker
