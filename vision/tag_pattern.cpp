#include "vision/tag_pattern.h"

#include <stdexcept>

#include "vision/libapriltag_family.h"

namespace nadir::vision {

TagPattern tag_pattern(int family, int id) {
  const LibraryFamily codes = library_family(family);
  if (id < 0 || id >= static_cast<int>(codes->ncodes)) {
    throw std::out_of_range("the family has no such tag");
  }
  TagPattern pattern;
  pattern.cells = codes->total_width;
  pattern.square_cells = codes->width_at_border;
  const auto paint = [&pattern](int column, int row) {
    const int cell = row * pattern.cells + column;
    pattern.white[static_cast<std::size_t>(cell)] = 1;
  };
  // A ring of white cells just outside of the square or, where the square is white on black, just
  // inside of it. What is neither ring nor code is black.
  const int first = (pattern.cells - pattern.square_cells) / 2 - (codes->reversed_border ? 0 : 1);
  const int last = pattern.cells - 1 - first;
  for (int i = first; i <= last; ++i) {
    paint(i, first);
    paint(i, last);
    paint(first, i);
    paint(last, i);
  }
  // Bits count from the highest; their places from the square's corner.
  const int corner = (pattern.cells - pattern.square_cells) / 2;
  for (int bit = 0; bit < static_cast<int>(codes->nbits); ++bit) {
    if (((codes->codes[id] >> (codes->nbits - 1 - bit)) & 1U) == 0) continue;
    paint(corner + static_cast<int>(codes->bit_x[bit]),
          corner + static_cast<int>(codes->bit_y[bit]));
  }
  return pattern;
}

}  // namespace nadir::vision
