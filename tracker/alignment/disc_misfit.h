#pragma once

#include <Eigen/Core>
#include <array>

#include "tracker/alignment/disc_sums.h"

namespace nadir::tracker {

/// Pulls of a disc's pixels at its centre, summed in eight sectors about it: the gradient of the
/// log likelihood, 1 / m, sector by sector.
using SectorPulls = std::array<Eigen::Vector2d, 8>;

/// Adds those of one channel. A pixel pulls by the derivative of its value by the centre, less what
/// level and contrast would `take` of it: rows for 1 and share, columns for x and y.
void add_pulls(const DiscPatch& patch, const DiscShares& shares, const ChannelModel& model,
               const Eigen::Matrix2d& take, SectorPulls& pulls);

/// Weighted sums over a channel's pixels in the disc and beside it, its edge apart, of products of
/// 1, place (u, v) and relative residual r: how the light runs over the disc. Weights are those of
/// the noise.
struct LightSums {
  float n = 0, u = 0, v = 0, uu = 0, vv = 0;
  float r = 0, ru = 0, rv = 0;
};
LightSums sum_light(const DiscPatch& patch, const DiscShares& shares, const ChannelModel& model);

}  // namespace nadir::tracker
