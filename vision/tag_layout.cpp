#include "vision/tag_layout.h"

#include <algorithm>

namespace nadir::vision {

std::optional<MountedTag> TagLayout::find(int tag_id) const {
  if (tags.empty()) {
    if (tag_id < 0 || tag_id >= facts().ids) return std::nullopt;
    return MountedTag{tag_id, tag_id, usual_mount};
  }
  const auto found = std::ranges::lower_bound(tags, tag_id, {}, &MountedTag::tag_id);
  if (found == tags.end() || found->tag_id != tag_id) return std::nullopt;
  return *found;
}

std::vector<MountedTag> TagLayout::tags_of(int robot_id) const {
  std::vector<MountedTag> own;
  if (tags.empty()) {
    if (const auto tag = find(robot_id)) own.push_back(*tag);
    return own;
  }
  std::ranges::copy_if(tags, std::back_inserter(own),
                       [robot_id](const MountedTag& tag) { return tag.robot_id == robot_id; });
  return own;
}

}  // namespace nadir::vision
