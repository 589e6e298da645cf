#pragma once

#include <Eigen/Core>
#include <array>

#include "tracker/alignment/disc_patch.h"

namespace nadir::tracker {

/// Variance of a pixel value of level L: read + shot L, grey levels squared.
struct PixelNoise {
  double read = 0.3;
  double shot = 0.03;

  double variance(double level) const { return read + shot * (level > 0.0 ? level : 0.0); }
};

/// How a blurred disc looks about its edge. With d the distance outside the edge in pixels, sigma
/// the blur (optics and pixel) and s = sigma / (2 R), a pixel's share in the disc is
///
///     Phi(z) - phi(z) (s^2 z + 4/3 s^3 (z^2 - 1)),   z = -d / sigma - s - 3 s^3
///
/// The exact convolution of a disc with a Gaussian is E Phi((sqrt(R^2 - (sigma y)^2) - r) / sigma)
/// over a normal y, the blur along the edge; this is its expansion by the cumulants of what the
/// curved edge falls back there: s + 3 s^3, 2 s^2, 8 s^3.
struct DiscEdge {
  double radius_m = 0.0;
  double blur_px = 0.0;
};

/// Shares of a patch's pixels in the disc, and their derivatives by its centre (per metre) and by
/// the blur (per pixel).
struct DiscShares {
  alignas(32) std::array<float, kPatchCapacity> share;
  alignas(32) std::array<float, kPatchCapacity> by_x;
  alignas(32) std::array<float, kPatchCapacity> by_y;
  alignas(32) std::array<float, kPatchCapacity> by_blur;
};

/// For a disc centred at `centre_m`.
void find_shares(const DiscPatch& patch, const DiscEdge& edge, const Eigen::Vector2d& centre_m,
                 DiscShares& shares);

/// Only the share, into a list as long as the patch: of a neighbour's disc.
void find_shares_of_neighbour(const DiscPatch& patch, const DiscEdge& edge,
                              const Eigen::Vector2d& centre_m, float* share);

/// One channel of a disc: value = level + contrast * share.
struct ChannelLevels {
  double level = 0.0;
  double contrast = 0.0;
};

/// Plain least squares of the two levels.
ChannelLevels fit_levels(const DiscPatch& patch, const DiscShares& shares, int channel);

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

/// How pixels are limited that do not belong there: beyond `huber` sigmas their pull stays the
/// same, beyond `far` sigmas it fades with their distance.
struct OutlierLimits {
  double huber_sigmas = 2.5;
  double far_sigmas = 1e9;
};

/// `base`: a list to be subtracted from the values (neighbours), or null. Weights are 1 over the
/// noise's variance, less beyond the limits. A pixel that is white and shall be whiter says
/// nothing.
ChannelSums sum_channel(const DiscPatch& patch, const DiscShares& shares, int channel,
                        const ChannelLevels& levels, const float* base, const PixelNoise& noise,
                        const OutlierLimits& limits);

/// What the residuals of one channel say of noise and blur.
struct ChannelScatter {
  float inside_count = 0, inside_squares = 0;    ///< of pixels wholly in the disc
  float outside_count = 0, outside_squares = 0;  ///< of pixels wholly beside it
  /// Sums of weight times by_blur b, with 1, s, b, r.
  float b = 0, sb = 0, bb = 0, br = 0;
  /// Of pixels wholly in the disc: place and residual, without weights.
  float du = 0, dv = 0, r = 0, uu = 0, vv = 0, ru = 0, rv = 0;
};

/// Weight times residual of each pixel of a channel, into a list as long as the patch.
void pulls_of(const DiscPatch& patch, const DiscShares& shares, int channel,
              const ChannelLevels& levels, const float* base, const PixelNoise& noise,
              const OutlierLimits& limits, float* pulls);

ChannelScatter scatter_of(const DiscPatch& patch, const DiscShares& shares, int channel,
                          const ChannelLevels& levels, const float* base, const PixelNoise& noise,
                          const OutlierLimits& limits);

}  // namespace nadir::tracker
