#include "tracker/alignment/disc_fit.h"

#include <Eigen/LU>
#include <cmath>

#include "vision/vector_clones.h"

namespace nadir::tracker {
namespace {

using lanes::Floats;
using lanes::kLanes;
using lanes::load;
using lanes::store;
using lanes::sum_of;

constexpr float kTiny = 1e-12F;
constexpr float kWhite = 253.5F;             // grey levels from here on may be more in truth
constexpr float kWholly = 0.99F;             // a share above or 1 - share below: no edge
constexpr float kFarthest_sigmas = 9.0F;     // beyond it a share is 0 or 1
constexpr float kMostScatter_sigmas = 3.5F;  // beyond it is something else than noise

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
  lanes::inverse_root(metric2, per_metric);
  const Floats distance = distance2 * per_distance;
  z0 = (g.radius - distance) * distance * per_metric * g.per_blur;
  z0 = z0 < kFarthest_sigmas ? z0 : z0 * 0.0F + kFarthest_sigmas;
  z0 = z0 > -kFarthest_sigmas ? z0 : z0 * 0.0F - kFarthest_sigmas;
}

NADIR_INLINE void share_of(const Geometry& g, const Floats& z, Floats& density, Floats& share) {
  lanes::normal(z, density, share);
  share -= density * (g.s * g.s * z + g.k * (z * z - 1.0F));
}

struct ChannelFit {
  float level, contrast;
  float variance0, variance_slope;  // of the noise: variance0 + variance_slope * share
  float huber, huber2;
  float far, far2;
};

ChannelFit channel_fit(const ChannelLevels& levels, const PixelNoise& noise,
                       const OutlierLimits& limits) {
  const double outside = noise.variance(levels.level);
  const double inside = noise.variance(levels.level + levels.contrast);
  const auto f = [](double value) { return static_cast<float>(value); };
  return {f(levels.level),
          f(levels.contrast),
          f(outside),
          f(inside - outside),
          f(limits.huber_sigmas),
          f(limits.huber_sigmas * limits.huber_sigmas),
          f(limits.far_sigmas),
          f(limits.far_sigmas * limits.far_sigmas)};
}

// Residual and weight of eight pixels.
NADIR_INLINE void judge(const ChannelFit& f, const Floats& value, const Floats& base,
                        const Floats& share, const Floats& use, Floats& residual, Floats& weight) {
  const Floats model = f.level + f.contrast * share + base;
  residual = value - model;
  Floats variance = f.variance0 + f.variance_slope * share;
  variance = variance > 0.05F ? variance : variance * 0.0F + 0.05F;
  weight = use / variance;
  const Floats squares = residual * residual * weight + kTiny;
  Floats per_root;
  lanes::inverse_root(squares, per_root);
  weight = squares > f.huber2 ? weight * per_root * f.huber : weight;
  weight = squares > f.far2 ? weight * per_root * f.far : weight;
  const Floats zero = {};
  const Floats too_white = model > value ? weight * 0.0F : weight;
  weight = value > kWhite ? too_white : weight;
  residual = weight > zero ? residual : zero;
}

}  // namespace

NADIR_VECTOR_CLONES
void find_shares(const DiscPatch& patch, const DiscEdge& edge, const Eigen::Vector2d& centre_m,
                 DiscShares& shares) {
  const Geometry g = geometry_of(patch, edge, centre_m);
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
    share_of(g, z, density, share);
    const Floats by_z = density * (1.0F - s2 * (1.0F - z * z) - g.k * z * (3.0F - z * z));
    const Floats scaled = by_z * g.per_blur;
    store(share, &shares.share[i]);
    store(scaled * x * per_metric, &shares.by_x[i]);
    store(scaled * y * per_metric, &shares.by_y[i]);
    store(-scaled * (z0 + by_blur_shift), &shares.by_blur[i]);
  }
}

NADIR_VECTOR_CLONES
void find_shares_of_neighbour(const DiscPatch& patch, const DiscEdge& edge,
                              const Eigen::Vector2d& centre_m, float* out) {
  const Geometry g = geometry_of(patch, edge, centre_m);
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
    Floats density;
    Floats share;
    share_of(g, z0 - g.shift, density, share);
    store(share, out + i);
  }
}

NADIR_VECTOR_CLONES
ChannelLevels fit_levels(const DiscPatch& patch, const DiscShares& shares, int channel) {
  Floats n = {};
  Floats s = {};
  Floats ss = {};
  Floats v = {};
  Floats sv = {};
  for (int i = patch.begin[channel]; i < patch.end[channel]; i += kLanes) {
    Floats use;
    Floats share;
    Floats value;
    load(&patch.use[i], use);
    load(&shares.share[i], share);
    load(&patch.value[channel][i], value);
    const Floats weighted = use * share;
    n += use;
    s += weighted;
    ss += weighted * share;
    v += use * value;
    sv += weighted * value;
  }
  const double sum_n = static_cast<double>(sum_of(n));
  const double sum_s = static_cast<double>(sum_of(s));
  const double sum_v = static_cast<double>(sum_of(v));
  const double determinant = sum_n * static_cast<double>(sum_of(ss)) - sum_s * sum_s;
  if (!(determinant > 1e-3 * sum_n)) return {sum_n > 0.0 ? sum_v / sum_n : 0.0, 0.0};
  const double contrast = (sum_n * static_cast<double>(sum_of(sv)) - sum_s * sum_v) / determinant;
  return {(sum_v - contrast * sum_s) / sum_n, contrast};
}

NADIR_VECTOR_CLONES
ChannelSums sum_channel(const DiscPatch& patch, const DiscShares& shares, int channel,
                        const ChannelLevels& levels, const float* base, const PixelNoise& noise,
                        const OutlierLimits& limits) {
  const ChannelFit fit = channel_fit(levels, noise, limits);
  Floats n = {}, s = {}, x = {}, y = {}, r = {};
  Floats ss = {}, sx = {}, sy = {}, sr = {};
  Floats xx = {}, xy = {}, xr = {}, yy = {}, yr = {}, rr = {};
  Floats pixels = {}, pull = {};
  const float* const values = patch.value[channel].data();
  for (int i = patch.begin[channel]; i < patch.end[channel]; i += kLanes) {
    Floats use;
    Floats share;
    Floats value;
    Floats by_x;
    Floats by_y;
    Floats below = {};
    load(&patch.use[i], use);
    load(&shares.share[i], share);
    load(values + i, value);
    load(&shares.by_x[i], by_x);
    load(&shares.by_y[i], by_y);
    if (base != nullptr) load(base + i, below);
    Floats residual;
    Floats weight;
    judge(fit, value, below, share, use, residual, weight);
    const Floats ws = weight * share;
    const Floats wx = weight * by_x;
    const Floats wy = weight * by_y;
    const Floats wr = weight * residual;
    n += weight;
    s += ws;
    x += wx;
    y += wy;
    r += wr;
    ss += ws * share;
    sx += ws * by_x;
    sy += ws * by_y;
    sr += ws * residual;
    xx += wx * by_x;
    xy += wx * by_y;
    xr += wx * residual;
    yy += wy * by_y;
    yr += wy * residual;
    rr += wr * residual;
    pixels += use;
    pull += wr * wr * (by_x * by_x + by_y * by_y);
  }
  return {sum_of(n),  sum_of(s),  sum_of(x),  sum_of(y),      sum_of(r),   sum_of(ss),
          sum_of(sx), sum_of(sy), sum_of(sr), sum_of(xx),     sum_of(xy),  sum_of(xr),
          sum_of(yy), sum_of(yr), sum_of(rr), sum_of(pixels), sum_of(pull)};
}

NADIR_VECTOR_CLONES
void pulls_of(const DiscPatch& patch, const DiscShares& shares, int channel,
              const ChannelLevels& levels, const float* base, const PixelNoise& noise,
              const OutlierLimits& limits, float* pulls) {
  const ChannelFit fit = channel_fit(levels, noise, limits);
  const float* const values = patch.value[channel].data();
  for (int i = patch.begin[channel]; i < patch.end[channel]; i += kLanes) {
    Floats use;
    Floats share;
    Floats value;
    Floats below = {};
    load(&patch.use[i], use);
    load(&shares.share[i], share);
    load(values + i, value);
    if (base != nullptr) load(base + i, below);
    Floats residual;
    Floats weight;
    judge(fit, value, below, share, use, residual, weight);
    store(weight * residual, pulls + i);
  }
}

NADIR_VECTOR_CLONES
ChannelScatter scatter_of(const DiscPatch& patch, const DiscShares& shares, int channel,
                          const ChannelLevels& levels, const float* base, const PixelNoise& noise,
                          const OutlierLimits& limits) {
  const ChannelFit fit = channel_fit(levels, noise, limits);
  Floats inside_count = {}, inside_squares = {}, outside_count = {}, outside_squares = {};
  Floats b = {}, sb = {}, bb = {}, br = {};
  Floats u = {}, v = {}, r = {}, uu = {}, vv = {}, ru = {}, rv = {};
  const Floats zero = {};
  const float* const values = patch.value[channel].data();
  for (int i = patch.begin[channel]; i < patch.end[channel]; i += kLanes) {
    Floats use;
    Floats share;
    Floats value;
    Floats by_blur;
    Floats below = {};
    load(&patch.use[i], use);
    load(&shares.share[i], share);
    load(values + i, value);
    load(&shares.by_blur[i], by_blur);
    if (base != nullptr) load(base + i, below);
    Floats residual;
    Floats weight;
    judge(fit, value, below, share, use, residual, weight);
    const Floats wb = weight * by_blur;
    b += wb;
    sb += wb * share;
    bb += wb * by_blur;
    br += wb * residual;
    const Floats squares = residual * residual;
    const Floats variance = fit.variance0 + fit.variance_slope * share;
    Floats counts = weight > zero ? use : zero;
    counts = squares < variance * (kMostScatter_sigmas * kMostScatter_sigmas) ? counts : zero;
    const Floats inside = share > kWholly ? counts : zero;
    Floats du;
    Floats dv;
    load(&patch.du[i], du);
    load(&patch.dv[i], dv);
    u += inside * du;
    v += inside * dv;
    r += inside * residual;
    uu += inside * du * du;
    vv += inside * dv * dv;
    ru += inside * residual * du;
    rv += inside * residual * dv;
    const Floats outside = share < 1.0F - kWholly ? counts : zero;
    inside_count += inside;
    inside_squares += inside * squares;
    outside_count += outside;
    outside_squares += outside * squares;
  }
  return {sum_of(inside_count),
          sum_of(inside_squares),
          sum_of(outside_count),
          sum_of(outside_squares),
          sum_of(b),
          sum_of(sb),
          sum_of(bb),
          sum_of(br),
          sum_of(u),
          sum_of(v),
          sum_of(r),
          sum_of(uu),
          sum_of(vv),
          sum_of(ru),
          sum_of(rv)};
}

}  // namespace nadir::tracker
