#include "tracker/alignment/disc_sums.h"

#include "tracker/alignment/channel_fit.h"
#include "vision/vector_clones.h"

namespace nadir::tracker {
namespace {

using lanes::Floats;
using lanes::kLanes;
using lanes::load;
using lanes::sum_of;
using namespace channel_fit;

constexpr float kWholly = 0.99F;             // a share above or 1 - share below: no edge
constexpr float kMostScatter_sigmas = 3.5F;  // beyond it is something else than noise

ChannelLevels levels_from(double n, double s, double ss, double v, double sv) {
  const double determinant = n * ss - s * s;
  if (!(determinant > 1e-3 * n)) return {n > 0.0 ? v / n : 0.0, 0.0};
  const double contrast = (n * sv - s * v) / determinant;
  return {(v - contrast * s) / n, contrast};
}

// Channels first to last have their values at the same pixels.
NADIR_INLINE void fit_segment(const DiscPatch& patch, const DiscShares& shares, int first, int last,
                              std::array<ChannelLevels, 3>& levels, double& share_sum) {
  Floats n = {};
  Floats s = {};
  Floats ss = {};
  Floats v[3] = {};
  Floats sv[3] = {};
  for (int i = patch.begin[first]; i < patch.end[first]; i += kLanes) {
    Floats use;
    Floats share;
    load(&patch.use[i], use);
    load(&shares.share[i], share);
    const Floats counted = use * share;
    n += use;
    s += counted;
    ss += counted * share;
    for (int c = first; c <= last; ++c) {
      Floats value;
      load(&patch.value[c][i], value);
      v[c] += use * value;
      sv[c] += counted * value;
    }
  }
  const auto d = [](const Floats& sums) { return static_cast<double>(sum_of(sums)); };
  const double sum_s = d(s);
  share_sum += sum_s;
  for (int c = first; c <= last; ++c) {
    levels[c] = levels_from(d(n), sum_s, d(ss), d(v[c]), d(sv[c]));
  }
}

}  // namespace

NADIR_VECTOR_CLONES
std::array<ChannelLevels, 3> fit_levels(const DiscPatch& patch, const DiscShares& shares,
                                        double& share_sum) {
  std::array<ChannelLevels, 3> levels;
  share_sum = 0.0;
  if (patch.begin[2] == patch.begin[0]) {
    fit_segment(patch, shares, 0, 2, levels, share_sum);
  } else {
    for (int c = 0; c < 3; ++c) fit_segment(patch, shares, c, c, levels, share_sum);
  }
  return levels;
}

NADIR_VECTOR_CLONES
ChannelSums sum_channel(const DiscPatch& patch, const DiscShares& shares,
                        const ChannelModel& model) {
  const Fit fit = fit_of(model);
  Floats n = {}, s = {}, x = {}, y = {}, r = {};
  Floats ss = {}, sx = {}, sy = {}, sr = {};
  Floats xx = {}, xy = {}, xr = {}, yy = {}, yr = {}, rr = {};
  Floats pixels = {}, pull = {};
  for (int i = patch.begin[model.channel]; i < patch.end[model.channel]; i += kLanes) {
    Pixels p;
    look_at(patch, shares, model, fit, i, p);
    Floats by_x;
    Floats by_y;
    load(&shares.by_x[i], by_x);
    load(&shares.by_y[i], by_y);
    const Floats ws = p.weight * p.share;
    const Floats wx = p.weight * by_x;
    const Floats wy = p.weight * by_y;
    const Floats wr = p.weight * p.residual;
    n += p.weight;
    s += ws;
    x += wx;
    y += wy;
    r += wr;
    ss += ws * p.share;
    sx += ws * by_x;
    sy += ws * by_y;
    sr += ws * p.residual;
    xx += wx * by_x;
    xy += wx * by_y;
    xr += wx * p.residual;
    yy += wy * by_y;
    yr += wy * p.residual;
    rr += wr * p.residual;
    pixels += p.use;
    pull += wr * wr * (by_x * by_x + by_y * by_y);
  }
  return {sum_of(n),  sum_of(s),  sum_of(x),  sum_of(y),      sum_of(r),   sum_of(ss),
          sum_of(sx), sum_of(sy), sum_of(sr), sum_of(xx),     sum_of(xy),  sum_of(xr),
          sum_of(yy), sum_of(yr), sum_of(rr), sum_of(pixels), sum_of(pull)};
}

NADIR_VECTOR_CLONES
ChannelScatter scatter_of(const DiscPatch& patch, const DiscShares& shares,
                          const ChannelModel& model) {
  const Fit fit = fit_of(model);
  constexpr int kSums = 20;
  Floats sums[kSums] = {};
  const Floats zero = {};
  for (int i = patch.begin[model.channel]; i < patch.end[model.channel]; i += kLanes) {
    Pixels p;
    look_at(patch, shares, model, fit, i, p);
    Floats by_blur;
    Floats du;
    Floats dv;
    load(&shares.by_blur[i], by_blur);
    load(&patch.du[i], du);
    load(&patch.dv[i], dv);
    const Floats squares = p.residual * p.residual;
    const Floats variance = fit.variance0 + fit.variance_slope * p.share;
    Floats counts = p.weight > zero ? p.use : zero;
    counts = squares < variance * (kMostScatter_sigmas * kMostScatter_sigmas) ? counts : zero;
    const Floats inside = p.share > kWholly ? counts : zero;
    const Floats outside = p.share < 1.0F - kWholly ? counts : zero;
    const Floats ws = p.weight * p.share;
    const Floats wb = p.weight * by_blur;
    const Floats off = inside * p.residual;
    const Floats terms[kSums] = {inside,           inside * squares,
                                 outside,          outside * squares,
                                 p.weight,         ws,
                                 ws * p.share,     p.weight * p.residual,
                                 ws * p.residual,  wb,
                                 wb * p.share,     wb * by_blur,
                                 wb * p.residual,  inside * du,
                                 inside * dv,      off,
                                 inside * du * du, inside * dv * dv,
                                 off * du,         off * dv};
    for (int k = 0; k < kSums; ++k) sums[k] += terms[k];
  }
  float totals[kSums];
  for (int k = 0; k < kSums; ++k) totals[k] = sum_of(sums[k]);
  return {totals[0],  totals[1],  totals[2],  totals[3],  totals[4],  totals[5],  totals[6],
          totals[7],  totals[8],  totals[9],  totals[10], totals[11], totals[12], totals[13],
          totals[14], totals[15], totals[16], totals[17], totals[18], totals[19]};
}

}  // namespace nadir::tracker
