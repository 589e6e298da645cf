#pragma once

#include <algorithm>

#include "fusion/body_rates.h"

namespace nadir::fusion {

/// What is assumed of a robot while no odometry comes: for a short time it goes on as before, after
/// a longer one it stands somewhere around where it was.
struct GapMotion {
  double hold_s = 0.1;  ///< up to this length the last rates are held
  /// Standard deviations of what may have happened: accelerations first, then any speed.
  double acceleration_mps2 = 3.0;
  double acceleration_radps2 = 30.0;
  double speed_mps = 1.0;
  double speed_radps = 6.0;
  /// The uncertainty grows no further: a hundred metres or half a turn.
  double largest_m = 100.0;
  double largest_rad = 3.14;

  BodyRates rates(const BodyRates& last, double dt_s) const {
    return dt_s <= hold_s ? last : BodyRates{};
  }
  /// Standard deviation of the place, m, in each direction, that the gap adds.
  double sigma_m(double dt_s) const {
    return std::min(std::min(acceleration_mps2 * dt_s, speed_mps) * dt_s, largest_m);
  }
  double sigma_rad(double dt_s) const {
    return std::min(std::min(acceleration_radps2 * dt_s, speed_radps) * dt_s, largest_rad);
  }
};

}  // namespace nadir::fusion
