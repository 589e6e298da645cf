#include "tracker/alignment/disc_misfit.h"

#include "tracker/alignment/channel_fit.h"
#include "vision/vector_clones.h"

namespace nadir::tracker {
namespace {

using lanes::Floats;
using lanes::kLanes;
using lanes::load;
using lanes::sum_of;
using namespace channel_fit;

constexpr float kNoEdge = 0.005F;    // share below, or above 1 less that
constexpr float kLeastLevel = 1.0F;  // grey levels: darker, and there is no light to compare

}  // namespace

NADIR_VECTOR_CLONES
void add_pulls(const DiscPatch& patch, const DiscShares& shares, const ChannelModel& model,
               const Eigen::Matrix2d& take, SectorPulls& pulls) {
  const Fit fit = fit_of(model);
  const auto level_x = static_cast<float>(take(0, 0));
  const auto level_y = static_cast<float>(take(0, 1));
  const auto share_x = static_cast<float>(take(1, 0));
  const auto share_y = static_cast<float>(take(1, 1));
  const Floats zero = {};
  Floats sums_x[8] = {};
  Floats sums_y[8] = {};
  for (int i = patch.begin[model.channel]; i < patch.end[model.channel]; i += kLanes) {
    Pixels p;
    look_at(patch, shares, model, fit, i, p);
    Floats x;
    Floats y;
    load(&shares.by_x[i], x);
    load(&shares.by_y[i], y);
    const Floats pull = p.weight * p.residual;
    const Floats pull_x = pull * (fit.contrast * x - level_x - share_x * p.share);
    const Floats pull_y = pull * (fit.contrast * y - level_y - share_y * p.share);
    // By the signs of x and y and which of them is larger: 1 where a pixel is in the sector.
    const Floats right = x > zero ? zero + 1.0F : zero;
    const Floats upper = y > zero ? zero + 1.0F : zero;
    const Floats beside = x * x > y * y ? zero + 1.0F : zero;
    for (int sector = 0; sector < 8; ++sector) {
      Floats here = (sector & 1) != 0 ? right : 1.0F - right;
      here *= (sector & 2) != 0 ? upper : 1.0F - upper;
      here *= (sector & 4) != 0 ? beside : 1.0F - beside;
      sums_x[sector] += here * pull_x;
      sums_y[sector] += here * pull_y;
    }
  }
  for (std::size_t sector = 0; sector < pulls.size(); ++sector) {
    pulls[sector] += Eigen::Vector2d(static_cast<double>(sum_of(sums_x[sector])),
                                     static_cast<double>(sum_of(sums_y[sector])));
  }
}

NADIR_VECTOR_CLONES
LightSums sum_light(const DiscPatch& patch, const DiscShares& shares, const ChannelModel& model) {
  const Fit fit = fit_of(model);
  const auto read = static_cast<float>(model.noise.read);
  const auto shot = static_cast<float>(model.noise.shot);
  const Floats zero = {};
  Floats n = {}, u = {}, v = {}, uu = {}, vv = {};
  Floats r = {}, ru = {}, rv = {};
  for (int i = patch.begin[model.channel]; i < patch.end[model.channel]; i += kLanes) {
    Floats use;
    Floats share;
    Floats value;
    Floats du;
    Floats dv;
    Floats base = {};
    load(&patch.use[i], use);
    load(&shares.share[i], share);
    load(&patch.value[model.channel][i], value);
    load(&patch.du[i], du);
    load(&patch.dv[i], dv);
    if (model.base != nullptr) load(model.base + i, base);
    const Floats expected = fit.level + fit.contrast * share + base;
    // Relative residual (value - expected) / expected, of variance noise / expected^2.
    Floats inverse = use / (read + shot * expected);
    inverse = expected < kLeastLevel ? zero : inverse;
    inverse = value > kWhite ? zero : inverse;
    const Floats of_edge = share < 1.0F - kNoEdge ? zero : inverse;
    inverse = share > kNoEdge ? of_edge : inverse;
    const Floats w = inverse * expected * expected;
    const Floats wr = inverse * expected * (value - expected);
    const Floats wu = w * du;
    const Floats wv = w * dv;
    n += w;
    u += wu;
    v += wv;
    uu += wu * du;
    vv += wv * dv;
    r += wr;
    ru += wr * du;
    rv += wr * dv;
  }
  return {sum_of(n),  sum_of(u), sum_of(v),  sum_of(uu),
          sum_of(vv), sum_of(r), sum_of(ru), sum_of(rv)};
}

}  // namespace nadir::tracker
