#pragma once

#include <array>

#include "tracker/alignment/disc_shares.h"
#include "tracker/alignment/pixel_noise.h"

namespace nadir::tracker {

/// One channel of a disc: value = level + contrast * share.
struct ChannelLevels {
  double level = 0.0;
  double contrast = 0.0;
};

/// Plain least squares of the two levels of each channel. `share_sum` becomes the sum of the shares
/// of all pixels that count.
std::array<ChannelLevels, 3> fit_levels(const DiscPatch& patch, const DiscShares& shares,
                                        double& share_sum);

/// A channel as it is thought to be: the pixels' values are those of a disc, of what `base` adds (a
/// list, or null: neighbours), and noise.
struct ChannelModel {
  int channel = 0;
  ChannelLevels levels;
  const float* base = nullptr;
  PixelNoise noise;
  OutlierLimits limits;
};

/// Weighted sums over one channel's pixels of products of 1, share s, by_x, by_y and the residual
/// r: all that a Gauss-Newton step needs.
struct ChannelSums {
  float n = 0, s = 0, x = 0, y = 0, r = 0;
  float ss = 0, sx = 0, sy = 0, sr = 0;
  float xx = 0, xy = 0, xr = 0, yy = 0, yr = 0, rr = 0;
  float pixels = 0;  ///< that count, without weight
  /// Sum of (weight residual)^2 (by_x^2 + by_y^2): how far the residuals pull at the centre.
  float pull = 0;
};

/// Weights are 1 over the noise's variance, less beyond the limits. A pixel that is white and shall
/// be whiter says nothing.
ChannelSums sum_channel(const DiscPatch& patch, const DiscShares& shares,
                        const ChannelModel& model);

/// What the residuals of one channel say of noise, light and blur.
struct ChannelScatter {
  float inside_count = 0, inside_squares = 0;    ///< of pixels wholly in the disc
  float outside_count = 0, outside_squares = 0;  ///< of pixels wholly beside it
  /// Weighted sums of products of 1, share s, by_blur b and the residual r.
  float n = 0, s = 0, ss = 0, r = 0, sr = 0, b = 0, sb = 0, bb = 0, br = 0;
  /// Of pixels wholly in the disc: place (u, v) and residual i, without weights.
  float u = 0, v = 0, i = 0, uu = 0, vv = 0, iu = 0, iv = 0;
};

/// `shares` with derivatives by the blur.
ChannelScatter scatter_of(const DiscPatch& patch, const DiscShares& shares,
                          const ChannelModel& model);

}  // namespace nadir::tracker
