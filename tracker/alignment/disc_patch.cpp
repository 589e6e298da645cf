#include "tracker/alignment/disc_patch.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "vision/vector_clones.h"

namespace nadir::tracker {
namespace {

using lanes::Floats;
using lanes::kLanes;
using lanes::load;
using lanes::store;

// The quadratic of one coordinate of the plane, counted from some point.
struct Quadratic {
  float c0, cu, cv, cuu, cuv, cvv;
};

Quadratic quadratic(const LocalPlane& plane, const Eigen::Vector2d& from_m, int axis) {
  return {static_cast<float>(plane.origin_m[axis] - from_m[axis]),
          static_cast<float>(plane.slope(axis, 0)),
          static_cast<float>(plane.slope(axis, 1)),
          static_cast<float>(plane.bend(axis, 0)),
          static_cast<float>(plane.bend(axis, 1)),
          static_cast<float>(plane.bend(axis, 2))};
}

NADIR_INLINE void evaluate(const Quadratic& q, const Floats& du, const Floats& dv, Floats& value) {
  value = q.c0 + du * (q.cu + q.cuu * du + q.cuv * dv) + dv * (q.cv + q.cvv * dv);
}

// The pixels of a row that lie in an ellipse.
struct Chord {
  int begin;
  int end;  // not included
};

// The window as an ellipse about `centre` in the image: offsets d with d^T metric d <= reach^2.
struct Ellipse {
  Eigen::Matrix2d metric;  // slope^T slope, m^2 per px^2
  double reach2_m2;
  vision::PixelPoint centre;

  double half_height_px() const {
    return std::sqrt(reach2_m2 * metric(0, 0) / metric.determinant());
  }
  Chord chord(int v, int columns) const {
    const double dv = v - centre.y();
    const double middle = centre.x() - metric(0, 1) / metric(0, 0) * dv;
    const double left = reach2_m2 - metric.determinant() / metric(0, 0) * dv * dv;
    if (left < 0.0) return {0, 0};
    const double half = std::sqrt(left / metric(0, 0));
    return {std::max(0, static_cast<int>(std::ceil(middle - half))),
            std::min(columns, static_cast<int>(std::floor(middle + half)) + 1)};
  }
};

void pad(DiscPatch& patch) {
  while (patch.count % kLanes != 0) {
    const auto i = static_cast<std::size_t>(patch.count++);
    patch.du[i] = 0.0F;
    patch.dv[i] = 0.0F;
    patch.use[i] = 0.0F;
    for (auto& channel : patch.value) channel[i] = 0.0F;
  }
}

// Sixteen pixels a turn, more than a row of most discs has: the compiler takes them apart at once.
// What lies beyond the chord is overwritten by the next row.
constexpr int kRun = 16;

NADIR_VECTOR_CLONES
void gather_row(const std::uint8_t* bgr, int count, float du, float dv, float* to_du, float* to_dv,
                float* blue, float* green, float* red) {
  for (int k = 0; k < count; k += kRun) {
    for (int i = k; i < k + kRun; ++i) {
      to_du[i] = du + static_cast<float>(i);
      to_dv[i] = dv;
      blue[i] = static_cast<float>(bgr[3 * i]);
      green[i] = static_cast<float>(bgr[3 * i + 1]);
      red[i] = static_cast<float>(bgr[3 * i + 2]);
    }
  }
}

void gather_all(const cv::Mat& image, const Ellipse& ellipse, int v_begin, int v_end, int v_step,
                int u0, int v0, DiscPatch& patch) {
  for (int v = v_begin; v < v_end; v += v_step) {
    const Chord chord = ellipse.chord(v, image.cols);
    const int count = std::max(0, chord.end - chord.begin);
    if (patch.count + count > kPatchCapacity - kLanes - kRun) break;
    const std::uint8_t* pixels =
        image.ptr<std::uint8_t>(v) + 3 * static_cast<std::ptrdiff_t>(chord.begin);
    // Never reads past the row's end: what would lie there is arbitrary.
    std::array<std::uint8_t, 3 * kRun> tail{};
    const int whole =
        chord.begin + (count + kRun - 1) / kRun * kRun <= image.cols ? count : count / kRun * kRun;
    const auto i = static_cast<std::size_t>(patch.count);
    const auto to = [&](int first, const std::uint8_t* from, int length) {
      const std::size_t k = i + static_cast<std::size_t>(first);
      gather_row(from, length, static_cast<float>(chord.begin + first - u0),
                 static_cast<float>(v - v0), &patch.du[k], &patch.dv[k], &patch.value[0][k],
                 &patch.value[1][k], &patch.value[2][k]);
    };
    to(0, pixels, whole);
    if (whole < count) {
      std::memcpy(tail.data(), pixels + 3 * static_cast<std::ptrdiff_t>(whole),
                  3 * static_cast<std::size_t>(count - whole));
      to(whole, tail.data(), count - whole);
    }
    patch.count += count;
  }
  std::fill_n(patch.use.begin(), patch.count, 1.0F);
  pad(patch);
  patch.begin = {0, 0, 0};
  patch.end = {patch.count, patch.count, patch.count};
}

void gather_native(const cv::Mat& image, Mosaic mosaic, const Ellipse& ellipse, int v_begin,
                   int v_end, int v_step, int u0, int v0, DiscPatch& patch) {
  const std::array<int, 4> native = native_channels(mosaic);
  const int channels = image.channels();
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    patch.begin[channel] = patch.count;
    for (int v = v_begin; v < v_end; v += v_step) {
      const Chord chord = ellipse.chord(v, image.cols);
      if (patch.count + chord.end - chord.begin > kPatchCapacity - kLanes) break;
      const std::uint8_t* row = image.ptr<std::uint8_t>(v) + (channels == 3 ? c : 0);
      auto i = static_cast<std::size_t>(patch.count);
      for (int u = chord.begin; u < chord.end; ++u) {
        if (native[static_cast<std::size_t>(2 * (v & 1) + (u & 1))] != c) continue;
        patch.du[i] = static_cast<float>(u - u0);
        patch.dv[i] = static_cast<float>(v - v0);
        patch.use[i] = 1.0F;
        patch.value[channel][i] = row[static_cast<std::ptrdiff_t>(channels) * u];
        ++i;
      }
      patch.count = static_cast<int>(i);
    }
    pad(patch);
    patch.end[channel] = patch.count;
  }
}

}  // namespace

bool gather(const cv::Mat& image, Mosaic mosaic, const PlaneGrid& grid, const PatchWindow& window,
            DiscPatch& patch) {
  patch.count = 0;
  const int u0 = static_cast<int>(std::lround(window.centre_px.x()));
  const int v0 = static_cast<int>(std::lround(window.centre_px.y()));
  patch.plane = grid.about(u0, v0);
  patch.origin_px = {u0, v0};
  Ellipse ellipse;
  ellipse.metric = patch.plane.slope.transpose() * patch.plane.slope;
  const double m_per_px = std::sqrt(std::sqrt(ellipse.metric.determinant()));
  const double reach_m = window.radius_m + window.margin_px * m_per_px;
  ellipse.reach2_m2 = reach_m * reach_m;
  ellipse.centre = window.centre_px;
  const double half_height = ellipse.half_height_px();
  const int v_begin = std::max(0, static_cast<int>(std::ceil(window.centre_px.y() - half_height)));
  const int v_end =
      std::min(image.rows, static_cast<int>(std::floor(window.centre_px.y() + half_height)) + 1);
  // Rows left out of large discs; with a mosaic by threes or more odd ones, so that both kinds of
  // rows stay.
  const double area_px = M_PI * ellipse.reach2_m2 / (m_per_px * m_per_px);
  int v_step = 1;
  while (area_px / v_step > 0.9 * kPatchCapacity) v_step += mosaic == Mosaic::kNone ? 1 : 2;
  if (mosaic == Mosaic::kNone) {
    gather_all(image, ellipse, v_begin, v_end, v_step, u0, v0, patch);
  } else {
    gather_native(image, mosaic, ellipse, v_begin, v_end, v_step, u0, v0, patch);
  }
  return patch.count > 0;
}

NADIR_VECTOR_CLONES
void flatten(const vision::PixelPoint& centre_px, const Eigen::Vector2d& light_slope_per_px,
             DiscPatch& patch) {
  const auto slope_u = static_cast<float>(light_slope_per_px.x());
  const auto slope_v = static_cast<float>(light_slope_per_px.y());
  const auto level = static_cast<float>(1.0 - light_slope_per_px.dot(centre_px - patch.origin_px));
  for (int c = 0; c < 3; ++c) {
    float* const values = patch.value[c].data();
    for (int i = patch.begin[c]; i < patch.end[c]; i += kLanes) {
      Floats du;
      Floats dv;
      Floats value;
      load(&patch.du[i], du);
      load(&patch.dv[i], dv);
      load(values + i, value);
      store(value / (level + slope_u * du + slope_v * dv), values + i);
    }
  }
}

NADIR_VECTOR_CLONES
void mask(const PlateShape& plate, const Eigen::Vector2d& origin_m, const Eigen::Vector2d& forward,
          const Obstacle* obstacles, int obstacle_count, DiscPatch& patch) {
  const Quadratic x = quadratic(patch.plane, origin_m, 0);
  const Quadratic y = quadratic(patch.plane, origin_m, 1);
  const auto cosine = static_cast<float>(forward.x());
  const auto sine = static_cast<float>(forward.y());
  const auto radius2 = static_cast<float>(plate.radius_m * plate.radius_m);
  const auto front = static_cast<float>(plate.front_m);
  std::array<float, kMostObstacles> ox;
  std::array<float, kMostObstacles> oy;
  std::array<float, kMostObstacles> o2;
  obstacle_count = std::min(obstacle_count, kMostObstacles);
  for (int k = 0; k < obstacle_count; ++k) {
    ox[k] = static_cast<float>(obstacles[k].place_m.x() - origin_m.x());
    oy[k] = static_cast<float>(obstacles[k].place_m.y() - origin_m.y());
    o2[k] = static_cast<float>(obstacles[k].radius_m * obstacles[k].radius_m);
  }
  const Floats zero = {};
  for (int i = 0; i < patch.count; i += kLanes) {
    Floats du;
    Floats dv;
    Floats use;
    load(&patch.du[i], du);
    load(&patch.dv[i], dv);
    load(&patch.use[i], use);
    Floats px;
    Floats py;
    evaluate(x, du, dv, px);
    evaluate(y, du, dv, py);
    use = px * px + py * py < radius2 ? use : zero;
    use = cosine * px + sine * py < front ? use : zero;
    for (int k = 0; k < obstacle_count; ++k) {
      const Floats dx = px - ox[k];
      const Floats dy = py - oy[k];
      use = dx * dx + dy * dy > o2[k] ? use : zero;
    }
    store(use, &patch.use[i]);
  }
}

NADIR_VECTOR_CLONES
void leave_to(const Eigen::Vector2d& own_centre_m, double own_radius_m,
              const Eigen::Vector2d& other_centre_m, double other_radius_m, DiscPatch& patch) {
  const Quadratic x = quadratic(patch.plane, own_centre_m, 0);
  const Quadratic y = quadratic(patch.plane, own_centre_m, 1);
  const auto ox = static_cast<float>(other_centre_m.x() - own_centre_m.x());
  const auto oy = static_cast<float>(other_centre_m.y() - own_centre_m.y());
  const auto difference = static_cast<float>(own_radius_m - other_radius_m);
  const Floats zero = {};
  constexpr float kTiny = 1e-12F;
  for (int i = 0; i < patch.count; i += kLanes) {
    Floats du;
    Floats dv;
    Floats use;
    load(&patch.du[i], du);
    load(&patch.dv[i], dv);
    load(&patch.use[i], use);
    Floats px;
    Floats py;
    evaluate(x, du, dv, px);
    evaluate(y, du, dv, py);
    const Floats own2 = px * px + py * py + kTiny;
    const Floats other2 = (px - ox) * (px - ox) + (py - oy) * (py - oy) + kTiny;
    Floats per_own;
    Floats per_other;
    lanes::inverse_root(own2, per_own);
    lanes::inverse_root(other2, per_other);
    use = own2 * per_own - other2 * per_other < difference ? use : zero;
    store(use, &patch.use[i]);
  }
}

}  // namespace nadir::tracker
