#pragma once

#include <Eigen/Core>
#include <array>

#include "tracker/alignment/disc_sums.h"
#include "vision/marker_layout.h"

namespace nadir::tracker {

/// What one disc's pixels say of its centre: Gauss-Newton's quadratic about the place where it was
/// evaluated, with levels and contrasts eliminated.
struct CentreEvidence {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();  ///< 1 / m^2
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();     ///< of the log likelihood, 1 / m
  double squares = 0.0;  ///< weighted residuals, levels fitted, at this place
  double pixels = 0.0;   ///< values that count
  /// Scatter of the pull at the centre over what noise would make: the misfit where it matters.
  double pull_ratio = 1.0;

  /// To where the disc itself fits best.
  Eigen::Vector2d own_step_m() const;
  /// Chi-square per degree of freedom after a step.
  double chi_square_per_dof(const Eigen::Vector2d& step_m) const;
  /// The pull's ratio after a step, to a tenth or so of what the step changes.
  double pull_ratio_after(const Eigen::Vector2d& step_m) const;
  /// The larger one of both: how badly the disc's template fits after a step.
  double misfit(const Eigen::Vector2d& step_m) const;

  static constexpr double kPullShare = 0.4;  ///< of the pixels pull at the centre

 private:
  /// What a step takes off the squares.
  double gain(const Eigen::Vector2d& step_m) const;
};

/// A disc at work: its pixels, their shares, its levels. Evaluate, step, evaluate again.
class DiscState {
 public:
  DiscPatch patch;
  DiscShares shares;
  std::array<ChannelLevels, 3> levels;
  /// A neighbour so near that its blurred edge reaches this disc's pixels; -1: none.
  std::array<int, 2> neighbours{-1, -1};

  /// Finds levels by plain least squares for a centre. After pixels were gathered.
  void start(const DiscEdge& edge, const Eigen::Vector2d& centre_m);
  /// After pixels were gathered anew for a disc whose levels are known.
  void start_anew(const DiscEdge& edge, const Eigen::Vector2d& centre_m);
  /// Adds the derivatives by the blur to the shares.
  void look_at_blur(const DiscEdge& edge);
  /// Shares of the pixels in the k-th neighbour's disc, with the neighbour's present contrast.
  void set_neighbour(int k, const DiscEdge& edge, const Eigen::Vector2d& centre_m,
                     const std::array<ChannelLevels, 3>& levels_of_neighbour);
  CentreEvidence evaluate(const DiscEdge& edge, const Eigen::Vector2d& centre_m,
                          const PixelNoise& noise, const OutlierLimits& limits);
  /// How the pull at the centre is spread about the disc, after `evaluate` with the same arguments:
  /// the covariance of eight sectors' pulls over what noise would make of it. About 1 for noise;
  /// large where neighbouring pixels err together, as at a shadow's edge, of which the squares of
  /// residuals tell too little. (A cluster-robust covariance; White, Econometrica 1980.)
  double structure(const CentreEvidence& evidence, const PixelNoise& noise,
                   const OutlierLimits& limits);
  /// Relative change of the light per pixel that the residuals show, in the disc and beside it but
  /// not at its edge, and what noise makes of it, one sigma.
  struct Slope {
    Eigen::Vector2d per_px = Eigen::Vector2d::Zero();
    double deviation_per_px = 0.0;
  };
  Slope light_slope(const PixelNoise& noise) const;
  /// Levels follow a step of the centre after the last evaluation.
  void follow(const Eigen::Vector2d& step_m);

  ChannelModel model(int channel, const PixelNoise& noise, const OutlierLimits& limits) const;
  /// Of the image: the shares of those that count, and those in the middle that are left out.
  double pixels_in_disc() const { return share_sum_ + patch.skipped; }

 private:
  Eigen::Vector2d shares_centre_m_ = Eigen::Vector2d::Zero();  // for which they were found last
  double share_sum_ = 0.0;
  std::array<ChannelSums, 3> sums_;
  alignas(32) std::array<std::array<float, kPatchCapacity>, 3> base_;
  alignas(32) std::array<float, kPatchCapacity> neighbour_share_;
};

}  // namespace nadir::tracker
