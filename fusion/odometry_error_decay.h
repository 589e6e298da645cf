#pragma once

namespace nadir::fusion {

/// e^(-dt / time constant): what is left of a first-order Gauss-Markov process's value after dt.
/// `dt_s` >= 0, `time_constant_s` > 0. The relative error is
/// below 1e-14 up to one time constant, 1e-12 up to a hundred. Additions and multiplications alone,
/// so that every processor gives the same bits (as sine_cosine.h).
inline double decay(double dt_s, double time_constant_s) {
  double x = dt_s / time_constant_s;
  if (!(x < 700.0)) return 0.0;
  int halvings = 0;
  for (; x > 0.03125; x *= 0.5) ++halvings;
  // Taylor's series; the first term left out is below 1e-19.
  double value =
      1.0 -
      x * (1.0 -
           x * (1.0 / 2 -
                x * (1.0 / 6 - x * (1.0 / 24 -
                                    x * (1.0 / 120 - x * (1.0 / 720 - x * (1.0 / 5040 -
                                                                           x * (1.0 / 40320))))))));
  for (; halvings > 0; --halvings) value *= value;
  return value;
}

}  // namespace nadir::fusion
