#include "vision/tag_family.h"

namespace nadir::vision {

std::optional<int> find_tag_family(const std::string& name) {
  for (std::size_t i = 0; i < kTagFamilies.size(); ++i) {
    if (name == kTagFamilies[i].name || "tag" + name == kTagFamilies[i].name) {
      return static_cast<int>(i);
    }
  }
  return std::nullopt;
}

std::vector<std::string> tag_families() {
  std::vector<std::string> names;
  names.reserve(kTagFamilies.size());
  for (const TagFamily& family : kTagFamilies) names.emplace_back(family.name);
  return names;
}

}  // namespace nadir::vision
