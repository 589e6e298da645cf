#include "tracker/alignment/tag_patch.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tracker/alignment/lanes.h"

namespace nadir::tracker {
namespace {

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
  }

  int half_height_px() const {
    const Eigen::Matrix2d px_from_tag = tag_from_px_.inverse();
    return static_cast<int>(std::ceil(reach_m_ * px_from_tag.row(1).lpNorm<1>()));
  }

  // Empty: high < low.
  void columns(int v, double& low, double& high) const {
    low = -1e6;
    high = 1e6;
    const double dv = v - middle_px_.y();
    for (int axis = 0; axis < 2; ++axis) {
      const double by_u = tag_from_px_(axis, 0);
      const double at = tag_from_px_(axis, 1) * dv;
      if (std::abs(by_u) < 1e-9 * reach_m_) {
        if (std::abs(at) > reach_m_) high = low - 1.0;
        continue;
      }
      const double one = (-reach_m_ - at) / by_u;
      const double other = (reach_m_ - at) / by_u;
      low = std::max(low, std::min(one, other));
      high = std::min(high, std::max(one, other));
    }
    low += middle_px_.x();
    high += middle_px_.x();
  }

 private:
  Eigen::Matrix2d tag_from_px_;
  vision::PixelPoint middle_px_;
  double reach_m_;
};

// Places of the pixels first, first + step, ... below `end` of a row; `at` counts on.
void place_run(const PlaneGrid& grid, const Eigen::Vector2d& from_m, int v, int first, int end,
               int step, int& at, TagPatch& patch) {
  for (int begin = first; begin < end; begin += kRun_px) {
    const int middle = begin + kRun_px / 2;
    const LocalPlane plane = grid.about(middle, v);
    const auto x0 = static_cast<float>(plane.origin_m.x() - from_m.x());
    const auto y0 = static_cast<float>(plane.origin_m.y() - from_m.y());
    const auto x1 = static_cast<float>(plane.slope(0, 0));
    const auto y1 = static_cast<float>(plane.slope(1, 0));
    const auto x2 = static_cast<float>(plane.bend(0, 0));
    const auto y2 = static_cast<float>(plane.bend(1, 0));
    for (int u = begin; u < std::min(end, begin + kRun_px); u += step, ++at) {
      const auto du = static_cast<float>(u - middle);
      patch.x_m[static_cast<std::size_t>(at)] = x0 + du * (x1 + du * x2);
      patch.y_m[static_cast<std::size_t>(at)] = y0 + du * (y1 + du * y2);
    }
  }
}

int pad(int at, TagPatch& patch) {
  for (; at % lanes::kLanes != 0; ++at) {
    const auto i = static_cast<std::size_t>(at);
    patch.x_m[i] = patch.y_m[i] = kFarAway_m;
    patch.value[i] = 0.0F;
  }
  return at;
}

}  // namespace

bool gather_tag(const cv::Mat& image, Mosaic mosaic, const PlaneGrid& grid,
                const fusion::PlanarPose& pose, const vision::PixelPoint& middle_px, double reach_m,
                TagPatch& patch) {
  const LocalPlane plane = grid.about(static_cast<int>(std::lround(middle_px.x())),
                                      static_cast<int>(std::lround(middle_px.y())));
  const SquareRows rows(plane, pose, middle_px, reach_m);
  const double area_px = 4.0 * reach_m * reach_m / std::abs(plane.slope.determinant());
  const int row_step = 1 + static_cast<int>(area_px / (0.95 * kTagPatchCapacity));
  const int half_height = rows.half_height_px();
  const int middle_v = static_cast<int>(std::lround(middle_px.y()));
  const int first_v = std::max(0, middle_v - half_height);
  const int end_v = std::min(image.rows, middle_v + half_height + 1);
  const int channels = image.channels();
  const std::array<int, 4> native = native_channels(mosaic);
  patch.segments = mosaic == Mosaic::kNone ? 1 : 3;
  int at = 0;
  int counted = 0;
  for (int segment = 0; segment < patch.segments; ++segment) {
    const auto c = static_cast<std::size_t>(segment);
    patch.begin[c] = at;
    for (int v = first_v; v < end_v; v += row_step) {
      double low = 0.0;
      double high = 0.0;
      rows.columns(v, low, high);
      int first = std::max(0, static_cast<int>(std::ceil(std::max(low, -1.0))));
      const int end = std::min(image.cols, static_cast<int>(std::floor(std::min(high, 1e5))) + 1);
      int step = 1;
      if (patch.segments == 3) {
        const std::array<int, 2> here = {native[static_cast<std::size_t>(2 * (v & 1))],
                                         native[static_cast<std::size_t>(2 * (v & 1) + 1)]};
        if (here[0] != segment && here[1] != segment) continue;
        if (here[static_cast<std::size_t>(first & 1)] != segment) ++first;
        step = 2;
      }
      if (end <= first) continue;
      if (at + (end - first) / step + 2 > kTagPatchCapacity - lanes::kLanes) break;
      int i = at;
      place_run(grid, pose.position_m(), v, first, end, step, at, patch);
      const std::uint8_t* pixel = image.ptr(v) + static_cast<std::ptrdiff_t>(channels) * first +
                                  (patch.segments == 3 && channels == 3 ? segment : 0);
      const bool sum = patch.segments == 1 && channels == 3;
      for (; i < at; ++i, pixel += static_cast<std::ptrdiff_t>(channels) * step) {
        const int value = sum ? pixel[0] + pixel[1] + pixel[2] : *pixel;
        patch.value[static_cast<std::size_t>(i)] = static_cast<float>(value);
      }
    }
    counted += at - patch.begin[c];
    at = pad(at, patch);
    patch.end[c] = at;
  }
  return counted > 0.5 * area_px / row_step;
}

}  // namespace nadir::tracker
