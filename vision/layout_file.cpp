#include <fmt/format.h>

#include <algorithm>

#include "vision/input/strict_yaml.h"
#include "vision/layout_ambiguity.h"
#include "vision/marker_layout.h"
#include "vision/tag_layout_file.h"

namespace nadir::vision {
namespace {

constexpr ValidRange kHeightRangeM{0.0, 2.0};
constexpr ValidRange kRadiusRangeM{0.002, 0.5};
constexpr ValidRange kPositionRangeM{-2.0, 2.0};
constexpr ValidRange kIdRange{0, 65535};

std::vector<std::string> colour_names() { return {kColourNames.begin(), kColourNames.end()}; }

Colour read_colour(const YamlMap& map, const std::string& key) {
  return colour_from_name(map.choice(key, colour_names()));
}

std::vector<Team> read_teams(const YamlMap& file) {
  const YamlMap map = file.map("teams");
  std::vector<Team> teams;
  for (const std::string& name : map.keys()) {
    const Team team{name, read_colour(map, name)};
    for (const Team& other : teams) {
      if (other.centre_colour != team.centre_colour) continue;
      throw map.error(name,
                      fmt::format("teams '{}' and '{}' have the same colour {}", other.name, name,
                                  colour_name(team.centre_colour)),
                      "give each team a colour of its own");
    }
    teams.push_back(team);
  }
  if (teams.empty()) throw file.error("teams", "'teams' is empty", "name one team and its colour");
  return teams;
}

Disc read_disc(const YamlMap& map, bool has_identities) {
  Disc disc;
  disc.position_robot_m = {map.number("x_m", kPositionRangeM), map.number("y_m", kPositionRangeM)};
  disc.radius_m = map.number("radius_m", kRadiusRangeM);
  if (!has_identities) {
    disc.colour = read_colour(map, "colour");
  } else if (map.has("colour")) {
    throw map.error("colour", "an outer disc has a colour although 'identities' gives the colours",
                    "remove one of the two");
  }
  map.finish();
  return disc;
}

/// `index` counts from 1 as a person does; the centre disc is 0.
std::string disc_title(int index) {
  return index == 0 ? "the centre disc" : fmt::format("outer disc {}", index);
}

std::vector<Disc> read_outer(const YamlMap& file, double centre_radius_m, bool has_identities) {
  const std::vector<YamlMap> maps = file.maps("outer");
  if (maps.empty() || maps.size() > kMaxDiscs - 1) {
    throw file.error("outer", fmt::format("'outer' has {} discs", maps.size()),
                     fmt::format("valid is from 1 to {}", kMaxDiscs - 1));
  }
  std::vector<Disc> discs{{Eigen::Vector2d::Zero(), centre_radius_m}};
  for (const YamlMap& map : maps) {
    const Disc disc = read_disc(map, has_identities);
    const int index = static_cast<int>(discs.size());
    for (int other = 0; other < index; ++other) {
      const double gap_m = (disc.position_robot_m - discs[other].position_robot_m).norm() -
                           disc.radius_m - discs[other].radius_m;
      if (gap_m >= 0.0) continue;
      throw map.error("x_m",
                      fmt::format("{} overlaps {} by {:.1f} mm", disc_title(index),
                                  disc_title(other), -1000.0 * gap_m),
                      "move them apart or make them smaller");
    }
    discs.push_back(disc);
  }
  discs.erase(discs.begin());
  return discs;
}

Identity read_identity(const YamlMap& map, const std::string& key, std::size_t outer_count) {
  Identity identity;
  identity.id = map.integer_key(key, kIdRange);
  const std::vector<std::string> names = map.texts(key);
  if (names.size() != outer_count) {
    throw map.error(key, fmt::format("identity {} has {} colours", key, names.size()),
                    fmt::format("write {}, one for each outer disc", outer_count));
  }
  for (const std::string& name : names) {
    const std::vector<std::string> known = colour_names();
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw map.error(key, fmt::format("identity {} has the unknown colour '{}'", key, name),
                      fmt::format("choose of {}", fmt::join(known, ", ")));
    }
    identity.outer_colours.push_back(colour_from_name(name));
  }
  return identity;
}

std::vector<Identity> read_identities(const YamlMap& map, std::size_t outer_count) {
  std::vector<Identity> identities;
  for (const std::string& key : map.keys()) {
    const Identity identity = read_identity(map, key, outer_count);
    for (const Identity& other : identities) {
      if (other.id == identity.id) {
        throw map.error(key, fmt::format("identity {} stands twice", identity.id),
                        "remove one of the two");
      }
      if (other.outer_colours == identity.outer_colours) {
        throw map.error(
            key, fmt::format("identities {} and {} have equal colours", other.id, identity.id),
            "give each identity colours of its own");
      }
    }
    identities.push_back(identity);
  }
  return identities;
}

void read_discs(const YamlMap& file, MarkerLayout& layout) {
  layout.teams = read_teams(file);
  layout.centre_radius_m = file.number("centre_radius_m", kRadiusRangeM);
  const std::optional<YamlMap> identities = file.map_if_present("identities");
  layout.outer = read_outer(file, layout.centre_radius_m, identities.has_value());
  if (!identities) return;
  layout.identities = read_identities(*identities, layout.outer.size());
  if (layout.identities.empty()) {
    throw file.error("identities", "'identities' is empty",
                     "list one robot or remove the key and give the outer discs colours");
  }
}

}  // namespace

MarkerLayout load_marker_layout(const std::filesystem::path& path) {
  const YamlMap file = YamlMap::load(path);
  const bool has_tags = file.choice("kind", {"discs", "apriltag"}) == "apriltag";
  MarkerLayout layout;
  layout.name = file.text("name");
  layout.height_m = file.number("height_m", kHeightRangeM);
  if (has_tags) {
    layout.teams = {{file.text_or("team", layout.name), Colour::kWhite}};
    layout.tags = read_tag_layout(file);
  } else {
    read_discs(file, layout);
  }
  file.finish();
  if (has_tags) return layout;
  if (const auto ambiguity = find_ambiguity(layout)) {
    throw file.error("outer", *ambiguity, "move a disc or change a colour");
  }
  return layout;
}

MarkerLayout load_disc_layout(const std::filesystem::path& path) {
  MarkerLayout layout = load_marker_layout(path);
  if (!layout.tags) return layout;
  const YamlMap file = YamlMap::load(path);
  throw file.error("kind", fmt::format("layout '{}' has tags", layout.name),
                   "name a layout of kind 'discs'");
}

}  // namespace nadir::vision
