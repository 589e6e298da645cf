#pragma once

#include <cmath>

namespace nadir::fusion {

struct SineCosine {
  double sine = 0.0;
  double cosine = 1.0;
};

/// Sine and cosine of an angle of at most some hundred rad, within 2e-16 (absolute) at |angle| up
/// to 10 rad. Made of additions and multiplications alone, so that every processor gives the same
/// bits; those of a C library differ in the last bit where it fuses multiplications, and a gate
/// could then decide otherwise on the robot than in the replay of its log.
inline SineCosine sine_cosine(double angle_rad) {
  // pi/2 in three parts, the first two short enough for an exact product with the quadrant.
  constexpr double kHalfPi1 = 0x1.921fb544p+0;
  constexpr double kHalfPi2 = 0x1.0b4611a6p-34;
  constexpr double kHalfPi3 = 0x1.3198a2e037073p-69;
  constexpr double kTwoOverPi = 0.63661977236758134308;

  const double quadrant = std::nearbyint(angle_rad * kTwoOverPi);
  const double x = ((angle_rad - quadrant * kHalfPi1) - quadrant * kHalfPi2) - quadrant * kHalfPi3;
  // Taylor's series, cut where |x| <= pi/4 leaves less than 1e-18.
  const double y = x * x;
  const double sine =
      x + x * y *
              (-1.0 / 6 +
               y * (1.0 / 120 + y * (-1.0 / 5040 +
                                     y * (1.0 / 362880 + y * (-1.0 / 39916800 +
                                                              y * (1.0 / 6227020800 +
                                                                   y * (-1.0 / 1307674368000)))))));
  const double cosine =
      1.0 +
      y * (-1.0 / 2 +
           y * (1.0 / 24 +
                y * (-1.0 / 720 +
                     y * (1.0 / 40320 + y * (-1.0 / 3628800 +
                                             y * (1.0 / 479001600 + y * (-1.0 / 87178291200 +
                                                                         y / 20922789888000)))))));
  switch (static_cast<long long>(quadrant) & 3) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

}  // namespace nadir::fusion
