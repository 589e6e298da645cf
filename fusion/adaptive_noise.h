#pragma once

#include <algorithm>

namespace nadir::fusion {

/// Scales the process noise by what the innovations say (theory 3.3: their normalised square, NIS,
/// has expectation 3). After every pose that was used
///
///     factor+ = factor (1 + gain (min(NIS, 12) / 2.95 - 1)),   least <= factor+ <= most
///
/// 2.95 is what a 3-sigma gate leaves of 3. It leaves a filter with fitting noise as it is, and
/// keeps a badly fitted one from trusting itself. The factor is part of the filter's recorded
/// state, so replay decides as the first pass did.
struct AdaptiveNoise {
  double gain = 0.0;  ///< 0: off; 0.02 settles within about 50 poses
  double least = 0.25;
  double most = 1000.0;

  /// Switched on, with the gain that the measurements of fusion/README.md were made with.
  static AdaptiveNoise on() { return {0.02, 0.25, 1000.0}; }

  double next(double factor, double nis) const {
    if (gain <= 0.0) return factor;
    constexpr double kExpectedNis = 2.95;
    constexpr double kLargestNis = 12.0;
    const double surprise = std::min(nis, kLargestNis) / kExpectedNis - 1.0;
    return std::clamp(factor * (1.0 + gain * surprise), least, most);
  }
};

}  // namespace nadir::fusion
