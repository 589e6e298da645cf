#include "vision/tag_layout_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace nadir::vision {
namespace {

constexpr ValidRange kSizeRangeM{0.005, 2.0};
constexpr ValidRange kPositionRangeM{-2.0, 2.0};
constexpr ValidRange kHeadingRangeRad{-2.0 * std::numbers::pi, 2.0 * std::numbers::pi};
constexpr ValidRange kRobotIdRange{0, 65535};

int read_family(const YamlMap& file) {
  const std::string name = file.text("family");
  if (const auto family = find_tag_family(name)) return *family;
  throw file.error("family", fmt::format("'{}' is no tag family", name),
                   fmt::format("choose of {}", fmt::join(tag_families(), ", ")));
}

TagMount read_mount(const YamlMap& map) {
  TagMount mount;
  mount.position_robot_m = {map.number_or("x_m", 0.0, kPositionRangeM),
                            map.number_or("y_m", 0.0, kPositionRangeM)};
  mount.heading_robot_rad = map.number_or("heading_rad", 0.0, kHeadingRangeRad);
  map.finish();
  return mount;
}

int read_tag_id(const YamlMap& map, const std::string& key, const TagFamily& family) {
  const int id = map.integer_key(key, {0, 1e9});
  if (id < family.ids) return id;
  throw map.error(key, fmt::format("{} has no tag {}", family.name, id),
                  fmt::format("its tags are 0 to {}", family.ids - 1));
}

std::vector<MountedTag> read_robots(const YamlMap& file, const TagLayout& layout) {
  std::vector<MountedTag> tags;
  const std::optional<YamlMap> map = file.map_if_present("robots");
  if (!map) return tags;
  for (const std::string& key : map->keys()) {
    const int id = read_tag_id(*map, key, layout.facts());
    if (std::ranges::find(tags, id, &MountedTag::tag_id) != tags.end()) {
      throw map->error(key, fmt::format("tag {} stands twice", id), "remove one of the two");
    }
    tags.push_back({id, map->integer(key, kRobotIdRange), layout.usual_mount});
  }
  if (tags.empty()) {
    throw file.error("robots", "'robots' is empty",
                     "write lines like 7: 1 (tag: robot), or remove the key");
  }
  std::ranges::sort(tags, {}, &MountedTag::tag_id);
  return tags;
}

void read_offsets(const YamlMap& file, TagLayout& layout) {
  const std::optional<YamlMap> map = file.map_if_present("offsets");
  if (!map) return;
  if (layout.tags.empty()) {
    throw file.error("offsets", "'offsets' gives places to single tags, but there is no 'robots'",
                     "write 'offset' for all tags, or list the tags in 'robots'");
  }
  std::vector<int> seen;
  for (const std::string& key : map->keys()) {
    const int id = read_tag_id(*map, key, layout.facts());
    const auto tag = std::ranges::find(layout.tags, id, &MountedTag::tag_id);
    if (tag == layout.tags.end()) {
      throw map->error(key, fmt::format("tag {} is not in 'robots'", id), "add it there");
    }
    if (std::ranges::find(seen, id) != seen.end()) {
      throw map->error(key, fmt::format("tag {} stands twice", id), "remove one of the two");
    }
    seen.push_back(id);
    tag->mount = read_mount(map->map(key));
  }
}

void check_places(const YamlMap& file, const TagLayout& layout) {
  for (const MountedTag& tag : layout.tags) {
    for (const MountedTag& other : layout.tags) {
      if (other.tag_id >= tag.tag_id || other.robot_id != tag.robot_id) continue;
      const double apart_m = (tag.mount.position_robot_m - other.mount.position_robot_m).norm();
      if (apart_m >= layout.size_m) continue;
      throw file.error(
          file.has("offsets") ? "offsets" : "robots",
          fmt::format("tags {} and {} of robot {} are {:.0f} mm apart and {:.0f} mm wide",
                      other.tag_id, tag.tag_id, tag.robot_id, 1000.0 * apart_m,
                      1000.0 * layout.size_m),
          "give each tag of a robot its own place in 'offsets'");
    }
  }
}

}  // namespace

TagLayout read_tag_layout(const YamlMap& file) {
  TagLayout layout;
  layout.family = read_family(file);
  layout.size_m = file.number("tag_size_m", kSizeRangeM);
  if (const auto offset = file.map_if_present("offset")) layout.usual_mount = read_mount(*offset);
  layout.tags = read_robots(file, layout);
  read_offsets(file, layout);
  check_places(file, layout);
  return layout;
}

}  // namespace nadir::vision
