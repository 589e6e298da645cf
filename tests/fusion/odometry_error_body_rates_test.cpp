#include "fusion/odometry_error_body_rates.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fusion/pose_filter.h"
#include "tests/fusion/numeric_jacobian.h"
#include "tests/fusion/random_stream.h"

namespace nadir::fusion {
namespace {

using ErrorState = BodyRateError::ErrorState;

OdometryStep accelerating_step() { return {{0.20, -0.05, 0.6}, {0.15, 0.02, 0.4}, 0.02, 0.02}; }

TEST(BodyRateError, DerivativeByTheErrorsIsThatOfFiniteDifferences) {
  const BodyRateError model;
  const OdometryStep step = accelerating_step();
  ErrorState error;
  error << 0.1, -0.05, 0.02, 0.15, -0.1, 0.05, 0.01, -0.004, 0.03;
  const auto rates = [&](const ErrorState& e) -> Eigen::Vector3d {
    return model.corrected(step, e).rates.vector();
  };
  const auto numeric = test::numeric_jacobian<3, 9>(rates, error);
  EXPECT_LT((model.corrected(step, error).by_error - numeric).norm(), 1e-9);
}

TEST(BodyRateError, EachErrorDoesWhatItsNameSays) {
  const BodyRateError model;
  const OdometryStep step = accelerating_step();
  const Eigen::Vector3d rate = step.mean_rates.vector();
  const Eigen::Vector3d derivative = (rate - step.previous_rates.vector()) / 0.02;
  const auto corrected = [&](int state, double value) -> Eigen::Vector3d {
    return model.corrected(step, value * ErrorState::Unit(state)).rates.vector();
  };
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis);
    EXPECT_LT((corrected(axis, 0.1) - (rate - 0.1 * rate[axis] * unit)).norm(), 1e-15);
    // A command that is 10 ms early is the motion 10 ms later.
    EXPECT_LT((corrected(3 + axis, 0.01) - (rate - 0.01 * derivative[axis] * unit)).norm(), 1e-15);
    EXPECT_LT((corrected(6 + axis, 0.02) - (rate - 0.02 * unit)).norm(), 1e-15);
  }
}

TEST(BodyRateError, LeadsAndDriftsAreStationaryGaussMarkovProcesses) {
  const BodyRateError model;
  OdometryStep step = accelerating_step();
  auto covariance = model.initial_covariance();
  for (int i = 0; i < 300; ++i) {
    step.dt_s = i % 2 == 0 ? 0.015 : 0.004;
    const auto change = model.transition(step);
    covariance =
        change.transition * covariance * change.transition.transpose() + change.noise_covariance;
  }
  EXPECT_LT((covariance - model.initial_covariance()).norm(), 1e-12);
  step.dt_s = 0.02;
  EXPECT_NEAR(model.transition(step).transition(4, 4), std::exp(-0.02 / 1.0), 1e-12);
  EXPECT_NEAR(model.transition(step).transition(7, 7), std::exp(-0.02 / 0.5), 1e-12);
}

/// A robot that turns after its commands, 7 percent slower, with good poses 30 times a second.
TEST(BodyRateError, FilterFindsScaleAndLeadOfCommands) {
  constexpr double kDt_s = 0.01;
  constexpr double kLead_s = 0.08;
  PoseFilter<AboutEstimate, BodyRateError> filter;
  const PoseCovariance r = Eigen::Vector3d(1e-6, 1e-6, 1e-5).asDiagonal();
  filter.start({}, r);
  test::RandomStream random(3);
  const auto commanded = [](double t) {
    return BodyRates{0.2 + 0.1 * std::sin(1.3 * t), 0.0, 0.8 * std::sin(0.9 * t)};
  };
  PlanarPose truth;
  double lead_sum = 0.0;
  int leads = 0;
  for (int k = 1; k <= 6000; ++k) {
    const double t = kDt_s * k;
    filter.predict({commanded(t), commanded(t - kDt_s), kDt_s, kDt_s});
    const BodyRates delayed = commanded(t - kLead_s);
    truth = moved(truth, {delayed.u_mps / 1.07, 0.0, delayed.r_radps}, kDt_s);
    if (k % 3 != 0) continue;
    const Eigen::Vector3d noise = random.normal(r);
    filter.correct(
        {truth.x_m + noise.x(), truth.y_m + noise.y(), wrap_angle(truth.heading_rad + noise.z())},
        r);
    // The lead of the turn shows while the turn rate changes.
    if (t > 10.0 && std::abs(std::cos(0.9 * t)) > 0.7) {
      lead_sum += filter.state().odometry_error[5];
      ++leads;
    }
  }
  EXPECT_NEAR(filter.state().odometry_error[0], 0.07 / 1.07, 0.02);
  EXPECT_NEAR(lead_sum / leads, kLead_s, 0.02);
}

TEST(BodyRateError, RefusesNegativeDeviations) {
  BodyRateErrorParameters parameters;
  parameters.drift_sigma.z() = -0.1;
  EXPECT_THROW(BodyRateError{parameters}, std::invalid_argument);
  parameters = {};
  parameters.drift_correlation_s = 0.0;
  EXPECT_THROW(BodyRateError{parameters}, std::invalid_argument);
}

}  // namespace
}  // namespace nadir::fusion
