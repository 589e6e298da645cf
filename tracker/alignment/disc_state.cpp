#include "tracker/alignment/disc_state.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tracker/alignment/disc_misfit.h"

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

Eigen::Vector2d CentreEvidence::own_step_m() const { return information.inverse() * gradient; }

double CentreEvidence::gain(const Eigen::Vector2d& step_m) const {
  return 2.0 * gradient.dot(step_m) - step_m.dot(information * step_m);
}

double CentreEvidence::chi_square_per_dof(const Eigen::Vector2d& step_m) const {
  const double dof = std::max(1.0, pixels - 8.0);
  return std::max(0.0, squares - gain(step_m)) / dof;
}

double CentreEvidence::pull_ratio_after(const Eigen::Vector2d& step_m) const {
  return std::max(0.0, pull_ratio - gain(step_m) / (kPullShare * std::max(1.0, pixels)));
}

double CentreEvidence::misfit(const Eigen::Vector2d& step_m) const {
  return std::max(chi_square_per_dof(step_m), pull_ratio_after(step_m));
}

void DiscState::start(const DiscEdge& edge, const Eigen::Vector2d& centre_m) {
  start_anew(edge, centre_m);
  levels = fit_levels(patch, shares, share_sum_);
}

void DiscState::start_anew(const DiscEdge& edge, const Eigen::Vector2d& centre_m) {
  find_shares(patch, edge, centre_m, shares);
  shares_centre_m_ = centre_m;
}

void DiscState::look_at_blur(const DiscEdge& edge) {
  find_shares_and_blur(patch, edge, shares_centre_m_, shares);
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

ChannelModel DiscState::model(int channel, const PixelNoise& noise,
                              const OutlierLimits& limits) const {
  const auto c = static_cast<std::size_t>(channel);
  return {channel, levels[c], neighbours[0] < 0 ? nullptr : base_[c].data(), noise, limits};
}

CentreEvidence DiscState::evaluate(const DiscEdge& edge, const Eigen::Vector2d& centre_m,
                                   const PixelNoise& noise, const OutlierLimits& limits) {
  if (centre_m != shares_centre_m_) find_shares(patch, edge, centre_m, shares);
  shares_centre_m_ = centre_m;
  CentreEvidence evidence;
  double pull = 0.0;
  double pull_of_noise = 0.0;
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    const ChannelSums sums = sum_channel(patch, shares, model(c, noise, limits));
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
    pull += contrast * contrast * static_cast<double>(sums.pull);
    pull_of_noise += contrast * contrast * bb.trace();
  }
  if (pull_of_noise > 0.0) evidence.pull_ratio = pull / pull_of_noise;
  return evidence;
}

double DiscState::structure(const CentreEvidence& evidence, const PixelNoise& noise,
                            const OutlierLimits& limits) {
  SectorPulls pulls;
  pulls.fill(Eigen::Vector2d::Zero());
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    const Normal n = normal_of(sums_[channel], levels[channel].contrast);
    if (n.solvable) add_pulls(patch, shares, model(c, noise, limits), n.aa_inverse * n.ab, pulls);
  }
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& pull : pulls) scatter += pull * pull.transpose();
  return 0.5 * (evidence.information.inverse() * scatter).trace();
}

DiscState::Slope DiscState::light_slope(const PixelNoise& noise) const {
  double sum = 0.0;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  double residual_sum = 0.0;
  const auto d = [](float value) { return static_cast<double>(value); };
  for (int c = 0; c < 3; ++c) {
    const LightSums sums = sum_light(patch, shares, model(c, noise, {}));
    sum += d(sums.n);
    residual_sum += d(sums.r);
    place += Eigen::Vector2d(d(sums.u), d(sums.v));
    squares += Eigen::Vector2d(d(sums.uu), d(sums.vv));
    moment += Eigen::Vector2d(d(sums.ru), d(sums.rv));
  }
  if (!(sum > 0.0)) return {};
  place /= sum;
  squares -= sum * place.cwiseAbs2();
  if (!(squares.minCoeff() > 0.0)) return {};
  return {(moment - residual_sum * place).cwiseQuotient(squares),
          1.0 / std::sqrt(squares.minCoeff())};
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

}  // namespace nadir::tracker
