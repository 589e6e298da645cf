#pragma once

#include <array>
#include <cstdint>

#include "vision/tag_family.h"

namespace nadir::vision {

inline constexpr int kMaxTagCells = 10;  ///< on a side

/// What is printed: black and white cells, the margin included. Row 0 is the uppermost of the
/// upright print, column 0 its left one.
struct TagPattern {
  int cells = 0;         ///< on a side
  int square_cells = 0;  ///< on a side of the detected square, in the middle
  std::array<std::uint8_t, kMaxTagCells * kMaxTagCells> white{};  ///< 1 or 0, row by row

  bool is_white(int column, int row) const { return white[row * cells + column] != 0; }
};

/// The print of one tag, from libapriltag's own codes. `family` is an index into kTagFamilies.
/// Throws std::out_of_range for a family or a number that does not exist.
TagPattern tag_pattern(int family, int id);

}  // namespace nadir::vision
