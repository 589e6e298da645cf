#pragma once

#include "tracker/alignment/disc_sums.h"
#include "tracker/alignment/lanes.h"

/// What all loops over one channel's pixels do with eight of them: residual and robust weight.
namespace nadir::tracker::channel_fit {

using lanes::Floats;
using lanes::load;

inline constexpr float kTiny = 1e-12F;
inline constexpr float kWhite = 253.5F;  ///< grey levels from here on may be more in truth

/// Values of a model as the loops need them.
struct Fit {
  float level, contrast;
  float variance0, variance_slope;  ///< of the noise: variance0 + variance_slope * share
  float huber, huber2;
  float far, far2;
};

inline Fit fit_of(const ChannelModel& model) {
  const double outside = model.noise.variance(model.levels.level);
  const double inside = model.noise.variance(model.levels.level + model.levels.contrast);
  const auto f = [](double value) { return static_cast<float>(value); };
  return {f(model.levels.level),
          f(model.levels.contrast),
          f(outside),
          f(inside - outside),
          f(model.limits.huber_sigmas),
          f(model.limits.huber_sigmas * model.limits.huber_sigmas),
          f(model.limits.far_sigmas),
          f(model.limits.far_sigmas * model.limits.far_sigmas)};
}

/// Eight pixels of a channel: what they show, what they miss, what that counts.
struct Pixels {
  Floats use, share, residual, weight;
};

NADIR_INLINE void judge(const Fit& f, const Floats& value, Pixels& p, const Floats& base) {
  const Floats model = f.level + f.contrast * p.share + base;
  p.residual = value - model;
  Floats variance = f.variance0 + f.variance_slope * p.share;
  variance = variance > 0.05F ? variance : variance * 0.0F + 0.05F;
  p.weight = p.use / variance;
  const Floats squares = p.residual * p.residual * p.weight + kTiny;
  Floats per_root;
  lanes::inverse_root<2>(squares, per_root);
  p.weight = squares > f.huber2 ? p.weight * per_root * f.huber : p.weight;
  p.weight = squares > f.far2 ? p.weight * per_root * f.far : p.weight;
  const Floats zero = {};
  const Floats too_white = model > value ? zero : p.weight;
  p.weight = value > kWhite ? too_white : p.weight;
  p.residual = p.weight > zero ? p.residual : zero;
}

NADIR_INLINE void look_at(const DiscPatch& patch, const DiscShares& shares,
                          const ChannelModel& model, const Fit& fit, int i, Pixels& p) {
  Floats value;
  Floats base = {};
  load(&patch.use[i], p.use);
  load(&shares.share[i], p.share);
  load(&patch.value[model.channel][i], value);
  if (model.base != nullptr) load(model.base + i, base);
  judge(fit, value, p, base);
}

}  // namespace nadir::tracker::channel_fit
