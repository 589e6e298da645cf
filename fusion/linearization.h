#pragma once

#include "fusion/body_rates.h"
#include "fusion/odometry.h"

namespace nadir::fusion {

/// The extended Kalman filter: covariances are propagated about the estimate and the measured
/// rates.
struct AboutEstimate {
  /// Nothing has to be given.
  struct Nominal {};

  static const Motion& motion(const Motion& estimated, const Nominal& /*nominal*/,
                              double /*dt_s*/) {
    return estimated;
  }
  static Nominal later(const Nominal& /*nominal*/, double /*dt_s*/) { return {}; }
};

/// The filter of S0 and S2: covariances are propagated along the nominal trajectory, which a wrong
/// estimate cannot spoil.
struct AlongNominal {
  /// Where the robot should be heading at the start of the step, and how it should be moving.
  struct Nominal {
    double heading_rad = 0.0;
    BodyRates rates;
  };

  static Motion motion(const Motion& /*estimated*/, const Nominal& nominal, double dt_s) {
    return constant_rate_motion(nominal.heading_rad, nominal.rates, dt_s);
  }
  /// The nominal motion at the start of the second part of a step that is split.
  static Nominal later(const Nominal& nominal, double dt_s) {
    return {nominal.heading_rad + nominal.rates.r_radps * dt_s, nominal.rates};
  }
};

}  // namespace nadir::fusion
