#pragma once

#include <Eigen/Core>
#include <array>

#include "tracker/alignment/patch_mask.h"
#include "vision/marker_layout.h"

namespace nadir::tracker {

/// What a robot of a layout looks like, without its colours: those are free when its pose is
/// estimated. Robot frame, metres.
struct DiscTemplate {
  int disc_count = 0;
  std::array<Eigen::Vector2d, vision::kMaxDiscs> place_m;
  std::array<double, vision::kMaxDiscs> radius_m{};
  /// At least so far reaches the plate on which the marks lie: a little beyond them. Nothing is
  /// said of it in layouts; the league's robots just have that much.
  PlateShape plate;
  double least_plate_m = 0.0;  ///< radius of a circle about the origin that holds most of each disc
  double reach_m = 0.0;        ///< from the origin to the rim of the outermost disc
};

DiscTemplate template_of(const vision::MarkerLayout& layout);

}  // namespace nadir::tracker
