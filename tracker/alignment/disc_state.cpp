#include "tracker/alignment/disc_state.h"

#include <Eigen/LU>
#include <algorithm>

namespace nadir::tracker {
namespace {

// One channel's normal equations: levels (a) and centre (b), the residual r on the right.
struct Normal {
  Eigen::Matrix2d aa;
  Eigen::Matrix2d ab;  // row: 1, share; column: x, y
  Eigen::Vector2d ar;
  bool solvable = false;
  Eigen::Matrix2d aa_inverse;
};

Normal normal_of(const ChannelSums& sums, double contrast) {
  Normal n;
  const auto d = [](float value) { return static_cast<double>(value); };
  n.aa << d(sums.n), d(sums.s), d(sums.s), d(sums.ss);
  n.ab << d(sums.x), d(sums.y), d(sums.sx), d(sums.sy);
  n.ab *= contrast;
  n.ar << d(sums.r), d(sums.sr);
  const double determinant = n.aa.determinant();
  n.solvable = determinant > 1e-4 * n.aa(0, 0) * n.aa(0, 0);
  if (n.solvable) n.aa_inverse = n.aa.inverse();
  return n;
}

}  // namespace

double CentreEvidence::chi_square_per_dof(const Eigen::Vector2d& step_m) const {
  const double dof = std::max(1.0, pixels - 8.0);
  const double left = squares - 2.0 * gradient.dot(step_m) + step_m.dot(information * step_m);
  return std::max(0.0, left) / dof;
}

void DiscState::start(const DiscEdge& edge, const Eigen::Vector2d& centre_m) {
  find_shares(patch, edge, centre_m, shares);
  for (int c = 0; c < 3; ++c) levels[static_cast<std::size_t>(c)] = fit_levels(patch, shares, c);
  for (auto& channel : base_) std::fill_n(channel.begin(), patch.count, 0.0F);
}

void DiscState::set_neighbour(int k, const DiscEdge& edge, const Eigen::Vector2d& centre_m,
                              const std::array<ChannelLevels, 3>& levels_of_neighbour) {
  find_shares_of_neighbour(patch, edge, centre_m, neighbour_share_.data());
  for (std::size_t c = 0; c < 3; ++c) {
    const auto contrast = static_cast<float>(levels_of_neighbour[c].contrast);
    float* const out = base_[c].data();
    const float* const share = neighbour_share_.data();
    if (k == 0) {
      for (int i = patch.begin[c]; i < patch.end[c]; ++i) out[i] = contrast * share[i];
    } else {
      for (int i = patch.begin[c]; i < patch.end[c]; ++i) out[i] += contrast * share[i];
    }
  }
}

const float* DiscState::base(int channel) const {
  return neighbours[0] < 0 ? nullptr : base_[static_cast<std::size_t>(channel)].data();
}

CentreEvidence DiscState::evaluate(const DiscEdge& edge, const Eigen::Vector2d& centre_m,
                                   const PixelNoise& noise, double huber_sigmas) {
  find_shares(patch, edge, centre_m, shares);
  CentreEvidence evidence;
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    const ChannelSums sums =
        sum_channel(patch, shares, c, levels[channel], base(c), noise, huber_sigmas);
    sums_[channel] = sums;
    const double contrast = levels[channel].contrast;
    const Normal n = normal_of(sums, contrast);
    if (!n.solvable) continue;
    Eigen::Matrix2d bb;
    bb << static_cast<double>(sums.xx), static_cast<double>(sums.xy), static_cast<double>(sums.xy),
        static_cast<double>(sums.yy);
    const Eigen::Vector2d br(static_cast<double>(sums.xr), static_cast<double>(sums.yr));
    evidence.information += contrast * contrast * bb - n.ab.transpose() * n.aa_inverse * n.ab;
    evidence.gradient += contrast * br - n.ab.transpose() * n.aa_inverse * n.ar;
    evidence.squares += static_cast<double>(sums.rr) - n.ar.dot(n.aa_inverse * n.ar);
    evidence.pixels += static_cast<double>(sums.pixels);
  }
  return evidence;
}

void DiscState::follow(const Eigen::Vector2d& step_m) {
  for (std::size_t c = 0; c < 3; ++c) {
    const Normal n = normal_of(sums_[c], levels[c].contrast);
    if (!n.solvable) continue;
    const Eigen::Vector2d change = n.aa_inverse * (n.ar - n.ab * step_m);
    levels[c].level += change[0];
    levels[c].contrast += change[1];
  }
}

double DiscState::pixels_in_disc() const {
  double sum = 0.0;
  for (int i = 0; i < patch.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    sum += static_cast<double>(patch.use[k] * shares.share[k]);
  }
  return sum;
}

}  // namespace nadir::tracker
