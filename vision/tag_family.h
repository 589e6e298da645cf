#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace nadir::vision {

/// A family of AprilTags: square marks whose numbers differ in so many cells that noise does not
/// turn one into another (Olson, ICRA 2011; Krogius, Haggenmiller, Olson, IROS 2019).
struct TagFamily {
  const char* name;  ///< as libapriltag says it
  int ids;           ///< numbers 0 to ids - 1
  int cells;         ///< on a side of the printed mark, its white margin included
  int square_cells;  ///< on a side of the square whose corners are detected
};

inline constexpr std::array<TagFamily, 4> kTagFamilies = {{
    {"tag36h11", 587, 10, 8},
    {"tag25h9", 35, 9, 7},
    {"tag16h5", 30, 8, 6},
    {"tagStandard41h12", 2115, 9, 5},
}};

/// Index into kTagFamilies of a name with or without "tag" before it, or nothing.
std::optional<int> find_tag_family(const std::string& name);

/// The names as libapriltag says them.
std::vector<std::string> tag_families();

}  // namespace nadir::vision
