#pragma once

#include <Eigen/Core>

namespace nadir::control_client {

/// Weights of the squared errors ahead (e1), to the side (e2) and of the heading (e3), against
/// those of both corrections, which are 1.
struct TrackingWeights {
  double ahead = 1.0;
  double side = 50.0;
  double heading = 0.0;
};

/// K of the correction K e: row 1 of the speed, row 2 of the turn rate; e in (m, m, rad). (S1 eq 15
/// calls its negative nu.)
using TrackingGains = Eigen::Matrix<double, 2, 3>;

/// The optimum on a straight line, in closed form; it is decentralised (theory 7):
///
///     k1 = sqrt q1,  k2 = sqrt q2,  k3 = sqrt(q3 + 2 v_r sqrt q2)
///
/// v_r > 0: the speed for which it holds, m/s. K = [k1 0 0; 0 k2 k3].
TrackingGains closed_form_gains(const TrackingWeights& weights, double speed_mps);

/// The optimum about a motion at constant speed and turn rate by the Riccati equation; coupled
/// where it turns.
TrackingGains riccati_gains(const TrackingWeights& weights, double speed_mps,
                            double turn_rate_radps);

/// The same for a controller that acts every `period_s`.
TrackingGains sampled_riccati_gains(const TrackingWeights& weights, double speed_mps,
                                    double turn_rate_radps, double period_s);

}  // namespace nadir::control_client
