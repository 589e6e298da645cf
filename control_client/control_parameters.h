#pragma once

namespace nadir::control_client {

/// One loop of the trajectory linearization control (S2 Table 5.1), the same for x, y and heading.
struct LoopParameters {
  double filter_damping = 0.7;           ///< zeta of the command filter
  double filter_bandwidth_radps = 8.0;   ///< w of the command filter
  double damping = 0.9;                  ///< zeta of the closed loop
  double natural_frequency_radps = 4.0;  ///< wn of the closed loop

  double integral_gain_per_s2() const {  ///< a_j1 = wn^2
    return natural_frequency_radps * natural_frequency_radps;
  }
  double proportional_gain_per_s() const {  ///< a_j2 = 2 zeta wn
    return 2.0 * damping * natural_frequency_radps;
  }
};

/// The defaults are S2 Table 5.1 and S0's sampling; the tolerated slip is our own.
struct ControlParameters {
  LoopParameters outer;
  LoopParameters inner{0.7, 40.0, 0.9, 20.0};
  double tick_s = 0.02;  ///< period of estimate and outer loop
  int inner_steps = 4;   ///< inner loop steps a tick: 1 is 50 Hz, 4 is 200 Hz
  /// On board the inner loop is so soft that wheels with slip times down to minus this do not swing
  /// it (slip_tolerance.h), s; 0: as stiff as `inner` says.
  double tolerated_slip_s = 0.08;

  double inner_step_s() const { return tick_s / inner_steps; }
};

}  // namespace nadir::control_client
