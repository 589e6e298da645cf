#include "control_client/differential/tracking_gains.h"

#include <Eigen/Dense>
#include <cmath>

#include "control_client/differential/riccati.h"

namespace nadir::control_client {
namespace {

// e' = A e + B (-nu), about a reference at constant rates: S1 eq 12.
Eigen::MatrixXd error_dynamics(double speed_mps, double turn_rate_radps) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3, 3);
  a(0, 1) = turn_rate_radps;
  a(1, 0) = -turn_rate_radps;
  a(1, 2) = speed_mps;
  return a;
}

Eigen::MatrixXd input() {
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(3, 2);
  b(0, 0) = 1.0;
  b(2, 1) = 1.0;
  return b;
}

Eigen::MatrixXd diagonal(const TrackingWeights& weights) {
  return Eigen::Vector3d(weights.ahead, weights.side, weights.heading).asDiagonal();
}

}  // namespace

TrackingGains closed_form_gains(const TrackingWeights& weights, double speed_mps) {
  const double side = std::sqrt(weights.side);
  TrackingGains gains = TrackingGains::Zero();
  gains(0, 0) = std::sqrt(weights.ahead);
  gains(1, 1) = side;
  gains(1, 2) = std::sqrt(weights.heading + 2.0 * speed_mps * side);
  return gains;
}

TrackingGains riccati_gains(const TrackingWeights& weights, double speed_mps,
                            double turn_rate_radps) {
  const Eigen::MatrixXd b = input();
  const Eigen::MatrixXd x =
      solve_continuous_riccati(error_dynamics(speed_mps, turn_rate_radps), b, diagonal(weights),
                               Eigen::MatrixXd::Identity(2, 2));
  return b.transpose() * x;
}

TrackingGains sampled_riccati_gains(const TrackingWeights& weights, double speed_mps,
                                    double turn_rate_radps, double period_s) {
  const SampledSystem system =
      sampled(error_dynamics(speed_mps, turn_rate_radps), input(), period_s);
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(2, 2);
  const Eigen::MatrixXd x =
      solve_discrete_riccati(system.a, system.b, diagonal(weights) * period_s, identity * period_s);
  const Eigen::MatrixXd gram = identity * period_s + system.b.transpose() * x * system.b;
  return gram.ldlt().solve(system.b.transpose() * x * system.a);
}

}  // namespace nadir::control_client
