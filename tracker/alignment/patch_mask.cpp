#include "tracker/alignment/patch_mask.h"

#include <algorithm>

#include "tracker/alignment/lanes.h"
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

// Of the pixels at `i`: where they lie on the plane, and if they count so far.
NADIR_INLINE void look_at(const DiscPatch& patch, const Quadratic& x, const Quadratic& y, int i,
                          Floats& px, Floats& py, Floats& use) {
  Floats du;
  Floats dv;
  load(&patch.du[i], du);
  load(&patch.dv[i], dv);
  load(&patch.use[i], use);
  evaluate(x, du, dv, px);
  evaluate(y, du, dv, py);
}

}  // namespace

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
    Floats px;
    Floats py;
    Floats use;
    look_at(patch, x, y, i, px, py, use);
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
    Floats px;
    Floats py;
    Floats use;
    look_at(patch, x, y, i, px, py, use);
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
