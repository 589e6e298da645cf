#include "vision/marker_layout.h"

#include <algorithm>
#include <numbers>
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

std::vector<int> MarkerLayout::robot_ids() const {
  std::vector<int> ids;
  for (const Identity& identity : identities) ids.push_back(identity.id);
  if (!tags) return ids;
  for (const MountedTag& tag : tags->tags) ids.push_back(tag.robot_id);
  for (int id = 0; tags->tags.empty() && id < tags->facts().ids; ++id) ids.push_back(id);
  std::ranges::sort(ids);
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

bool MarkerLayout::has_robot(int id) const {
  if (is_anonymous()) return true;
  if (tags) return !tags->tags_of(id).empty();
  return std::ranges::find(identities, id, &Identity::id) != identities.end();
}

double MarkerLayout::extent_m() const {
  double extent_m = centre_radius_m;
  for (const Disc& disc : outer) {
    extent_m = std::max(extent_m, disc.position_robot_m.norm() + disc.radius_m);
  }
  if (!tags) return extent_m;
  const double half_diagonal_m = 0.5 * std::numbers::sqrt2 * tags->printed_size_m();
  if (tags->tags.empty()) return tags->usual_mount.position_robot_m.norm() + half_diagonal_m;
  for (const MountedTag& tag : tags->tags) {
    extent_m = std::max(extent_m, tag.mount.position_robot_m.norm() + half_diagonal_m);
  }
  return extent_m;
}

Colour colour_from_name(const std::string& name) {
  for (int i = 0; i < kColourCount; ++i) {
    if (name == kColourNames[i]) return static_cast<Colour>(i);
  }
  throw std::out_of_range("no colour is called '" + name + "'");
}

}  // namespace nadir::vision
