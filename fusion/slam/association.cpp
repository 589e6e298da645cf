#include "fusion/slam/association.h"

#include <cmath>
#include <limits>

namespace nadir::fusion {
namespace {

Pairing none() {
  Pairing pairing;
  pairing.fill(-1);
  return pairing;
}

/// Depth-first search through the sightings; each is paired with one of its candidates or left out.
class JointSearch {
 public:
  JointSearch(const Candidates& candidates, int sightings, double gate, int most_steps)
      : candidates_(candidates), sightings_(sightings), gate_(gate), steps_left_(most_steps) {}

  Pairing best() {
    search(0, 0, 0.0);
    return best_;
  }

 private:
  static constexpr int kRows = 2 * kMaxSightings;

  void search(int sighting, int pairs, double distance) {
    if (--steps_left_ < 0) return;
    if (sighting == sightings_) {
      if (pairs > best_pairs_ || (pairs == best_pairs_ && distance < best_distance_)) {
        best_ = now_;
        best_pairs_ = pairs;
        best_distance_ = distance;
      }
      return;
    }
    if (pairs + sightings_ - sighting < best_pairs_) return;  // cannot become the best any more
    for (int i = 0; i < candidates_.count; ++i) {
      const Candidate& each = candidates_.pair[static_cast<std::size_t>(i)];
      if (each.sighting != sighting || each.distance > gate_) continue;
      if (is_taken(each.landmark, pairs)) continue;
      const double with = distance + added_distance(i, pairs);
      if (!(with <= chi_square_99(2 * (pairs + 1)))) continue;
      now_[static_cast<std::size_t>(sighting)] = i;
      search(sighting + 1, pairs + 1, with);
      now_[static_cast<std::size_t>(sighting)] = -1;
    }
    search(sighting + 1, pairs, distance);
  }

  bool is_taken(int landmark, int pairs) const {
    for (int k = 0; k < pairs; ++k) {
      const int i = chosen_[static_cast<std::size_t>(k)];
      if (candidates_.pair[static_cast<std::size_t>(i)].landmark == landmark) return true;
    }
    return false;
  }

  /// Appends two rows to the Cholesky factor of the chosen pairs' covariance; what they add to
  /// v^T S^-1 v = |L^-1 v|^2.
  double added_distance(int candidate, int pairs) {
    chosen_[static_cast<std::size_t>(pairs)] = candidate;
    const Candidate& own = candidates_.pair[static_cast<std::size_t>(candidate)];
    double added = 0.0;
    for (int k = 0; k < 2; ++k) {
      const int row = 2 * pairs + k;
      for (int column = 0; column <= row; ++column) {
        const int other = chosen_[static_cast<std::size_t>(column / 2)];
        double sum = candidates_.covariance(2 * candidate + k, 2 * other + column % 2);
        for (int j = 0; j < column; ++j) sum -= factor_(row, j) * factor_(column, j);
        if (column < row) {
          factor_(row, column) = sum / factor_(column, column);
        } else if (sum > 0.0) {
          factor_(row, row) = std::sqrt(sum);
        } else {
          return std::numeric_limits<double>::infinity();
        }
      }
      double white = own.innovation[k];
      for (int j = 0; j < row; ++j) white -= factor_(row, j) * white_[j];
      white_[row] = white / factor_(row, row);
      added += white_[row] * white_[row];
    }
    return added;
  }

  const Candidates& candidates_;
  int sightings_;
  double gate_;
  int steps_left_;
  Pairing now_ = none();
  Pairing best_ = none();
  int best_pairs_ = 0;
  double best_distance_ = std::numeric_limits<double>::infinity();
  std::array<int, kMaxSightings> chosen_{};
  Eigen::Matrix<double, kRows, kRows> factor_;
  Eigen::Matrix<double, kRows, 1> white_;
};

}  // namespace

Pairing nearest_neighbours(const Candidates& candidates, int sightings, double gate) {
  Pairing pairing = none();
  for (int round = 0; round < sightings; ++round) {
    int best = -1;
    for (int i = 0; i < candidates.count; ++i) {
      const Candidate& each = candidates.pair[static_cast<std::size_t>(i)];
      bool is_free = pairing[static_cast<std::size_t>(each.sighting)] < 0;
      for (const int chosen : pairing) {
        is_free = is_free &&
                  (chosen < 0 ||
                   candidates.pair[static_cast<std::size_t>(chosen)].landmark != each.landmark);
      }
      const bool is_nearer =
          best < 0 || each.distance < candidates.pair[static_cast<std::size_t>(best)].distance;
      if (is_free && is_nearer && each.distance <= gate) best = i;
    }
    if (best < 0) break;
    const int sighting = candidates.pair[static_cast<std::size_t>(best)].sighting;
    pairing[static_cast<std::size_t>(sighting)] = best;
  }
  return pairing;
}

Pairing joint_compatibility(const Candidates& candidates, int sightings, double gate,
                            int most_steps) {
  return JointSearch(candidates, sightings, gate, most_steps).best();
}

double chi_square_99(int degrees_of_freedom) {
  constexpr double kNormal99 = 2.3263478740408408;
  const double a = 2.0 / (9.0 * degrees_of_freedom);
  const double root = 1.0 - a + kNormal99 * std::sqrt(a);
  return degrees_of_freedom * root * root * root;
}

}  // namespace nadir::fusion
