#include "tracker/alignment/disc_shares.h"

#include <Eigen/LU>
#include <cmath>

#include "tracker/alignment/lanes.h"
#include "vision/vector_clones.h"

namespace nadir::tracker {
namespace {

using lanes::Floats;
using lanes::kLanes;
using lanes::load;
using lanes::store;

constexpr float kTiny = 1e-12F;
constexpr float kFarthest_sigmas = 9.0F;  // beyond it a share is 0 or 1

// Everything about a disc and its patch that is the same for all pixels.
struct Geometry {
  float x0, xu, xv, xuu, xuv, xvv;
  float y0, yu, yv, yuu, yuv, yvv;
  float gxx, gxy, gyy;  // slope slope^T: (metres per pixel)^2 in a direction of the plane
  float radius;
  float per_blur;
  float s, k;  // of DiscEdge; k = 4/3 s^3
  float shift;
};

Geometry geometry_of(const DiscPatch& patch, const DiscEdge& edge,
                     const Eigen::Vector2d& centre_m) {
  const LocalPlane& plane = patch.plane;
  const Eigen::Matrix2d metric = plane.slope * plane.slope.transpose();
  const double m_per_px = std::sqrt(std::sqrt(metric.determinant()));
  const double s = 0.5 * edge.blur_px * m_per_px / edge.radius_m;
  const auto f = [](double value) { return static_cast<float>(value); };
  return {f(plane.origin_m.x() - centre_m.x()),
          f(plane.slope(0, 0)),
          f(plane.slope(0, 1)),
          f(plane.bend(0, 0)),
          f(plane.bend(0, 1)),
          f(plane.bend(0, 2)),
          f(plane.origin_m.y() - centre_m.y()),
          f(plane.slope(1, 0)),
          f(plane.slope(1, 1)),
          f(plane.bend(1, 0)),
          f(plane.bend(1, 1)),
          f(plane.bend(1, 2)),
          f(metric(0, 0)),
          f(metric(0, 1)),
          f(metric(1, 1)),
          f(edge.radius_m),
          f(1.0 / edge.blur_px),
          f(s),
          f(4.0 / 3.0 * s * s * s),
          f(s + 3.0 * s * s * s)};
}

// Offset (x, y) of a pixel's place from the disc's centre, 1 / (|offset| metres per pixel in that
// direction), and z0 = -d / sigma.
NADIR_INLINE void locate(const Geometry& g, const Floats& du, const Floats& dv, Floats& x,
                         Floats& y, Floats& per_metric, Floats& z0) {
  x = g.x0 + du * (g.xu + g.xuu * du + g.xuv * dv) + dv * (g.xv + g.xvv * dv);
  y = g.y0 + du * (g.yu + g.yuu * du + g.yuv * dv) + dv * (g.yv + g.yvv * dv);
  const Floats distance2 = x * x + y * y + kTiny;
  const Floats metric2 = x * (g.gxx * x + 2.0F * g.gxy * y) + g.gyy * y * y + kTiny * g.gxx;
  Floats per_distance;
  lanes::inverse_root(distance2, per_distance);
  lanes::inverse_root<2>(metric2, per_metric);
  const Floats distance = distance2 * per_distance;
  z0 = (g.radius - distance) * distance * per_metric * g.per_blur;
  z0 = z0 < kFarthest_sigmas ? z0 : z0 * 0.0F + kFarthest_sigmas;
  z0 = z0 > -kFarthest_sigmas ? z0 : z0 * 0.0F - kFarthest_sigmas;
}

enum class Wanted { kShare, kByPlace, kByPlaceAndBlur };

template <Wanted kWanted>
NADIR_INLINE void find(const DiscPatch& patch, const Geometry& g, float* to_share,
                       DiscShares* shares) {
  const float s2 = g.s * g.s;
  const float by_blur_shift = g.s + 9.0F * g.s * s2;
  for (int i = 0; i < patch.count; i += kLanes) {
    Floats du;
    Floats dv;
    load(&patch.du[i], du);
    load(&patch.dv[i], dv);
    Floats x;
    Floats y;
    Floats per_metric;
    Floats z0;
    locate(g, du, dv, x, y, per_metric, z0);
    const Floats z = z0 - g.shift;
    Floats density;
    Floats share;
    lanes::normal(z, density, share);
    share -= density * (s2 * z + g.k * (z * z - 1.0F));
    store(share, to_share + i);
    if constexpr (kWanted != Wanted::kShare) {
      const Floats by_z = density * (1.0F - s2 * (1.0F - z * z) - g.k * z * (3.0F - z * z));
      const Floats scaled = by_z * g.per_blur;
      store(scaled * x * per_metric, &shares->by_x[i]);
      store(scaled * y * per_metric, &shares->by_y[i]);
      if constexpr (kWanted == Wanted::kByPlaceAndBlur) {
        store(-scaled * (z0 + by_blur_shift), &shares->by_blur[i]);
      }
    }
  }
}

}  // namespace

NADIR_VECTOR_CLONES
void find_shares(const DiscPatch& patch, const DiscEdge& edge, const Eigen::Vector2d& centre_m,
                 DiscShares& shares) {
  find<Wanted::kByPlace>(patch, geometry_of(patch, edge, centre_m), shares.share.data(), &shares);
}

NADIR_VECTOR_CLONES
void find_shares_and_blur(const DiscPatch& patch, const DiscEdge& edge,
                          const Eigen::Vector2d& centre_m, DiscShares& shares) {
  find<Wanted::kByPlaceAndBlur>(patch, geometry_of(patch, edge, centre_m), shares.share.data(),
                                &shares);
}

NADIR_VECTOR_CLONES
void find_shares_of_neighbour(const DiscPatch& patch, const DiscEdge& edge,
                              const Eigen::Vector2d& centre_m, float* share) {
  find<Wanted::kShare>(patch, geometry_of(patch, edge, centre_m), share, nullptr);
}

}  // namespace nadir::tracker
