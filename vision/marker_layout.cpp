#include "vision/marker_layout.h"

#include <stdexcept>

namespace nadir::vision {

Disc MarkerLayout::disc(int index, int team, int identity) const {
  if (index == 0) {
    return {Eigen::Vector2d::Zero(), centre_radius_m, teams.at(team).centre_colour};
  }
  Disc disc = outer.at(index - 1);
  if (!is_anonymous()) disc.colour = identities.at(identity).outer_colours.at(index - 1);
  return disc;
}

Colour colour_from_name(const std::string& name) {
  for (int i = 0; i < kColourCount; ++i) {
    if (name == kColourNames[i]) return static_cast<Colour>(i);
  }
  throw std::out_of_range("no colour is called '" + name + "'");
}

}  // namespace nadir::vision
