#pragma once

#include <Eigen/Core>
#include <array>

#include "tracker/alignment/disc_patch.h"

namespace nadir::tracker {

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

/// Shares and their derivatives by the centre, for a disc centred at `centre_m`.
void find_shares(const DiscPatch& patch, const DiscEdge& edge, const Eigen::Vector2d& centre_m,
                 DiscShares& shares);

/// Those by the blur too.
void find_shares_and_blur(const DiscPatch& patch, const DiscEdge& edge,
                          const Eigen::Vector2d& centre_m, DiscShares& shares);

/// Only the share, into a list as long as the patch: of a neighbour's disc.
void find_shares_of_neighbour(const DiscPatch& patch, const DiscEdge& edge,
                              const Eigen::Vector2d& centre_m, float* share);

}  // namespace nadir::tracker
