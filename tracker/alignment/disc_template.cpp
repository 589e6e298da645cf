#include "tracker/alignment/disc_template.h"

#include <algorithm>

namespace nadir::tracker {
namespace {

constexpr double kBeyondMarks_m = 0.005;
constexpr double kBeforeMarks_m = 0.010;
constexpr double kKept = 0.4;  // of a disc's radius beyond its centre

}  // namespace

DiscTemplate template_of(const vision::MarkerLayout& layout) {
  DiscTemplate result;
  result.disc_count = layout.disc_count();
  double foremost_m = 0.0;
  for (int i = 0; i < result.disc_count; ++i) {
    const vision::Disc disc = layout.disc(i, 0, 0);
    const auto index = static_cast<std::size_t>(i);
    result.place_m[index] = disc.position_robot_m;
    result.radius_m[index] = disc.radius_m;
    result.reach_m = std::max(result.reach_m, disc.position_robot_m.norm() + disc.radius_m);
    result.least_plate_m =
        std::max(result.least_plate_m, disc.position_robot_m.norm() + kKept * disc.radius_m);
    foremost_m = std::max(foremost_m, disc.position_robot_m.x() + disc.radius_m);
  }
  result.plate = {result.reach_m + kBeyondMarks_m, foremost_m + kBeforeMarks_m};
  return result;
}

}  // namespace nadir::tracker
