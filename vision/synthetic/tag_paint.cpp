#include "vision/synthetic/tag_paint.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nadir::vision {
namespace {

/// The cells that a sample touches along one axis of the tag: `second_share` of it in the second.
struct Touched {
  int first = 0;
  int second = 0;
  float second_share = 0.0F;
};

Touched touched_cells(float place, float half_width) {
  const float low = place - half_width;
  const float high = place + half_width;
  Touched touched;
  touched.first = static_cast<int>(std::floor(low));
  touched.second = static_cast<int>(std::floor(high));
  if (touched.second > touched.first) {
    touched.second_share = (high - static_cast<float>(touched.second)) / (2.0F * half_width);
  }
  return touched;
}

}  // namespace

double PaintedTag::extent_m() const { return 0.5 * std::numbers::sqrt2 * cell_m * pattern.cells; }

void paint_tag(const PaintedTag& tag, const float* x_m, const float* y_m, int begin, int end,
               float sample_m, Eigen::Array4f* row) {
  const auto c = static_cast<float>(std::cos(tag.mount.heading_robot_rad) / tag.cell_m);
  const auto s = static_cast<float>(std::sin(tag.mount.heading_robot_rad) / tag.cell_m);
  const Eigen::Vector2f middle = tag.mount.position_robot_m.cast<float>();
  const int cells = tag.pattern.cells;
  const float half_cells = 0.5F * static_cast<float>(cells);
  const float half_width = std::min(0.5F, 0.5F * sample_m / static_cast<float>(tag.cell_m));
  for (int i = begin; i < end; ++i) {
    const float dx = x_m[i] - middle.x();
    const float dy = y_m[i] - middle.y();
    const Touched columns = touched_cells(half_cells + c * dx + s * dy, half_width);
    const Touched rows = touched_cells(half_cells + s * dx - c * dy, half_width);
    float coverage = 0.0F;
    float white = 0.0F;
    for (int k = 0; k < 4; ++k) {
      const int column = (k & 1) != 0 ? columns.second : columns.first;
      const int cell_row = (k & 2) != 0 ? rows.second : rows.first;
      if (column < 0 || column >= cells || cell_row < 0 || cell_row >= cells) continue;
      const float share = ((k & 1) != 0 ? columns.second_share : 1.0F - columns.second_share) *
                          ((k & 2) != 0 ? rows.second_share : 1.0F - rows.second_share);
      coverage += share;
      if (tag.pattern.is_white(column, cell_row)) white += share;
    }
    row[i] = row[i] * (1.0F - coverage) + white * tag.white + (coverage - white) * tag.black;
  }
}

}  // namespace nadir::vision
