#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

namespace nadir::fusion {

/// Most sightings that are judged together, and most pairs of sighting and landmark among them.
inline constexpr int kMaxSightings = 16;
inline constexpr int kMaxCandidates = 48;

/// A sighting that may be of a landmark.
struct Candidate {
  int sighting = 0;
  int landmark = 0;
  Eigen::Vector2d innovation = Eigen::Vector2d::Zero();  ///< range, bearing
  double distance = 0.0;  ///< v^T S^-1 v of this pair alone, chi-square with 2 degrees of freedom
};

/// All pairs that are possible by themselves, and the covariance of all their innovations together:
/// rows and columns 2 i, 2 i + 1 belong to candidate i. Candidates of one sighting stand together.
struct Candidates {
  std::array<Candidate, kMaxCandidates> pair;
  int count = 0;
  Eigen::Matrix<double, 2 * kMaxCandidates, 2 * kMaxCandidates> covariance;

  bool add(const Candidate& candidate) {
    if (count >= kMaxCandidates) return false;
    pair[static_cast<std::size_t>(count++)] = candidate;
    return true;
  }
};

/// For each sighting the candidate that was chosen, or -1.
using Pairing = std::array<int, kMaxSightings>;

/// Each sighting takes the landmark that is nearest in the sense of `distance`, the nearest pairs
/// first, up to the gate; a landmark is given once.
Pairing nearest_neighbours(const Candidates& candidates, int sightings, double gate);

/// The largest set of pairs, each within the gate, whose innovations are likely together, and among
/// sets of that size the likeliest (Neira and Tardos, "Data association in stochastic mapping using
/// the joint compatibility test", 2001): v^T S^-1 v of all pairs is below the chi-square quantile
/// of 99 % for twice their number. What the robot's own error has in common for all landmarks is in
/// S, so that neighbours a hand apart are told from each other where several are seen at once. The
/// search ends after `most_steps` with the best set so far. At least as many pairs as a subset of
/// the nearest neighbours that is jointly compatible.
Pairing joint_compatibility(const Candidates& candidates, int sightings, double gate,
                            int most_steps = 5000);

/// Quantile of 99 % of chi-square; degrees of freedom 1 to 32, even beyond (Wilson and Hilferty's
/// approximation, within 1 % of it for 2 and more).
double chi_square_99(int degrees_of_freedom);

}  // namespace nadir::fusion
