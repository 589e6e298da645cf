#include "tracker/alignment/tag_patch.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "tracker/alignment/bgr_run.h"
#include "vision/vector_clones.h"

namespace nadir::tracker {
namespace {

using bgr_run::kRun;
using bgr_run::Values;

constexpr int kRun_px = 16;  // along a row, from one node of the plane's grid
constexpr float kFarAway_m = 1e3F;

// The columns of row v that lie in a square of the tag's frame, by the plane's slope about its
// middle.
class SquareRows {
 public:
  SquareRows(const LocalPlane& plane, const fusion::PlanarPose& pose,
             const vision::PixelPoint& middle_px, double reach_m)
      : middle_px_(middle_px), reach_m_(reach_m) {
    const double c = std::cos(pose.heading_rad);
    const double s = std::sin(pose.heading_rad);
    Eigen::Matrix2d tag_from_world;
    tag_from_world << c, s, -s, c;
    tag_from_px_ = tag_from_world * plane.slope;
    for (int axis = 0; axis < 2; ++axis) {
      const double by_u = tag_from_px_(axis, 0);
      crosses_[axis] = std::abs(by_u) >= 1e-9 * reach_m_;
      px_per_m_[axis] = crosses_[axis] ? 1.0 / by_u : 0.0;
    }
  }

  int half_height_px() const {
    const Eigen::Matrix2d px_from_tag = tag_from_px_.inverse();
    return static_cast<int>(std::ceil(reach_m_ * px_from_tag.row(1).lpNorm<1>()));
  }

  // Empty: high < low.
  __attribute__((always_inline)) void columns(int v, double& low, double& high) const {
    low = -1e6;
    high = 1e6;
    const double dv = v - middle_px_.y();
    for (int axis = 0; axis < 2; ++axis) {
      const double at = tag_from_px_(axis, 1) * dv;
      if (!crosses_[axis]) {
        if (std::abs(at) > reach_m_) high = low - 1.0;
        continue;
      }
      const double one = (-reach_m_ - at) * px_per_m_[axis];
      const double other = (reach_m_ - at) * px_per_m_[axis];
      low = std::max(low, std::min(one, other));
      high = std::min(high, std::max(one, other));
    }
    low += middle_px_.x();
    high += middle_px_.x();
  }

 private:
  Eigen::Matrix2d tag_from_px_;
  Eigen::Vector2d px_per_m_;           // along the rows, for each axis of the tag
  Eigen::Matrix<bool, 2, 1> crosses_;  // the axis changes along the rows
  vision::PixelPoint middle_px_;
  double reach_m_;
};

int pad(int at, TagPatch& patch) {
  for (; at % lanes::kLanes != 0 || at % kRun != 0; ++at) {
    const auto i = static_cast<std::size_t>(at);
    patch.x_m[i] = patch.y_m[i] = kFarAway_m;
    patch.value[i] = 0.0F;
  }
  return at;
}

// Every `step`-th of the rows that the square touches, and what is fetched between them.
struct RowRange {
  int begin, end, step;
  vision::PixelFetch& meanwhile;
};

// Pixels of a row, the last not included; empty: end <= begin.
struct Chord {
  int begin, end;
};

NADIR_INLINE Chord chord_of(const SquareRows& rows, int v, int columns) {
  double low = 0.0;
  double high = 0.0;
  rows.columns(v, low, high);
  return {std::max(0, static_cast<int>(std::ceil(std::max(low, -1.0)))),
          std::min(columns, static_cast<int>(std::floor(std::min(high, 1e5))) + 1)};
}

// Places of the pixels of a chord, every `step`-th, into the patch from `at` on. Writes up to seven
// places more. Returns how many.
NADIR_INLINE int place_chord(const PlaneGrid& grid, const Eigen::Vector2d& from_m, int v,
                             const Chord& chord, int step, int at, TagPatch& patch) {
  const Values steps = Values{0, 1, 2, 3, 4, 5, 6, 7} * static_cast<float>(step);
  int count = 0;
  for (int begin = chord.begin; begin < chord.end; begin += kRun_px) {
    const int middle = begin + kRun_px / 2;
    const LocalPlane plane = grid.about(middle, v);
    const auto x0 = static_cast<float>(plane.origin_m.x() - from_m.x());
    const auto y0 = static_cast<float>(plane.origin_m.y() - from_m.y());
    const auto x1 = static_cast<float>(plane.slope(0, 0));
    const auto y1 = static_cast<float>(plane.slope(1, 0));
    const auto x2 = static_cast<float>(plane.bend(0, 0));
    const auto y2 = static_cast<float>(plane.bend(1, 0));
    const int end = std::min(chord.end, begin + kRun_px);
    for (int u = begin; u < end; u += kRun * step) {
      const Values du = steps + static_cast<float>(u - middle);
      const Values x = x0 + du * (x1 + du * x2);
      const Values y = y0 + du * (y1 + du * y2);
      const int i = at + count;
      std::memcpy(&patch.x_m[static_cast<std::size_t>(i)], &x, sizeof(x));
      std::memcpy(&patch.y_m[static_cast<std::size_t>(i)], &y, sizeof(y));
      count += std::min(kRun, (end - u + step - 1) / step);
    }
  }
  return count;
}

// The sums of three channels that were all measured.
NADIR_VECTOR_CLONES
int gather_sums(const cv::Mat& image, const PlaneGrid& grid, const Eigen::Vector2d& from_m,
                const SquareRows& rows, const RowRange& range, TagPatch& patch) {
  int at = 0;
  for (int v = range.begin; v < range.end; v += range.step) {
    range.meanwhile.next_row();
    const Chord chord = chord_of(rows, v, image.cols);
    if (chord.end <= chord.begin) continue;
    if (at + chord.end - chord.begin > kTagPatchCapacity - 2 * kRun) break;
    const auto* row = image.ptr<std::uint8_t>(v);
    const int row_bytes = 3 * image.cols;
    for (int u = chord.begin; u < chord.end; u += kRun) {
      bgr_run::Words words;
      Values blue, green, red;
      bgr_run::load(row, row_bytes, u, words);
      bgr_run::channel(words, 0, blue);
      bgr_run::channel(words, 1, green);
      bgr_run::channel(words, 2, red);
      const Values sum = blue + green + red;
      std::memcpy(&patch.value[static_cast<std::size_t>(at + u - chord.begin)], &sum, sizeof(sum));
    }
    at += place_chord(grid, from_m, v, chord, 1, at, patch);
  }
  return at;
}

// Those pixels that measured `channel`, or all of a grey image: -1.
int gather_channel(const cv::Mat& image, Mosaic mosaic, int channel, const PlaneGrid& grid,
                   const Eigen::Vector2d& from_m, const SquareRows& rows, const RowRange& range,
                   int at, TagPatch& patch) {
  const std::array<int, 4> native = native_channels(mosaic);
  const std::ptrdiff_t channels = image.channels();
  const int step = channel < 0 ? 1 : 2;
  for (int v = range.begin; v < range.end; v += range.step) {
    range.meanwhile.next_row();
    Chord chord = chord_of(rows, v, image.cols);
    if (channel >= 0) {
      const std::size_t first = (v & 1) == 0 ? 0 : 2;
      const std::array<int, 2> here = {native[first], native[first + 1]};
      if (here[0] != channel && here[1] != channel) continue;
      if (here[static_cast<std::size_t>(chord.begin & 1)] != channel) ++chord.begin;
    }
    if (chord.end <= chord.begin) continue;
    if (at + (chord.end - chord.begin) / step > kTagPatchCapacity - 2 * kRun) break;
    const std::uint8_t* row = image.ptr(v) + (channels == 3 ? channel : 0);
    int i = at;
    at += place_chord(grid, from_m, v, chord, step, at, patch);
    for (int u = chord.begin; u < chord.end; u += step, ++i) {
      patch.value[static_cast<std::size_t>(i)] = static_cast<float>(row[channels * u]);
    }
  }
  return at;
}

}  // namespace

bool gather_tag(const cv::Mat& image, Mosaic mosaic, const PlaneGrid& grid,
                const fusion::PlanarPose& pose, const vision::PixelPoint& middle_px, double reach_m,
                vision::PixelFetch& meanwhile, TagPatch& patch) {
  const int middle_v = static_cast<int>(std::lround(middle_px.y()));
  const LocalPlane plane = grid.about(static_cast<int>(std::lround(middle_px.x())), middle_v);
  const SquareRows rows(plane, pose, middle_px, reach_m);
  const double area_px = 4.0 * reach_m * reach_m / std::abs(plane.slope.determinant());
  const int half_height = rows.half_height_px();
  const RowRange range = {std::max(0, middle_v - half_height),
                          std::min(image.rows, middle_v + half_height + 1),
                          1 + static_cast<int>(area_px / (0.95 * kTagPatchCapacity)), meanwhile};
  const Eigen::Vector2d from_m = pose.position_m();
  const bool sums = mosaic == Mosaic::kNone && image.channels() == 3;
  patch.segments = mosaic == Mosaic::kNone ? 1 : 3;
  int at = 0;
  int counted = 0;
  for (int segment = 0; segment < patch.segments; ++segment) {
    const auto c = static_cast<std::size_t>(segment);
    patch.begin[c] = at;
    at = sums ? gather_sums(image, grid, from_m, rows, range, patch)
              : gather_channel(image, mosaic, patch.segments == 1 ? -1 : segment, grid, from_m,
                               rows, range, at, patch);
    counted += at - patch.begin[c];
    at = pad(at, patch);
    patch.end[c] = at;
  }
  return counted > 0.5 * area_px / range.step;
}

}  // namespace nadir::tracker
