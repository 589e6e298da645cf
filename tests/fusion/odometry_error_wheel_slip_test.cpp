#include "fusion/odometry_error_wheel_slip.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "fusion/delayed_fusion.h"
#include "fusion/pose_filter.h"
#include "tests/fusion/numeric_jacobian.h"
#include "tests/fusion/random_stream.h"

namespace nadir::fusion {
namespace {

using Three = WheelSlipError<3>;
using SlipFilter = PoseFilter<AboutEstimate, Three>;

OdometryStep accelerating_step() { return {{0.20, -0.05, 0.6}, {0.15, 0.02, 0.4}, 0.02, 0.02}; }

WheelGeometry geometry() { return WheelGeometry::three_wheel(0.07); }

/// What the encoders of wheels with these scales and slip times would have measured.
BodyRates measured_with(const Eigen::Matrix<double, 6, 1>& error, const BodyRates& rates,
                        const BodyRates& before, double interval_s) {
  const WheelValues speed = geometry().rim_speeds_mps(rates);
  const WheelValues acceleration = (speed - geometry().rim_speeds_mps(before)) / interval_s;
  WheelValues measured = speed;
  for (int i = 0; i < 3; ++i) measured[i] += error[i] * speed[i] + error[3 + i] * acceleration[i];
  return geometry().body_rates(measured);
}

TEST(OdometryErrorDecay, IsTheExponential) {
  for (const double x : {0.0, 1e-9, 1e-3, 0.02, 0.124, 0.126, 0.5, 1.0, 3.0, 20.0, 100.0}) {
    EXPECT_NEAR(decay(x, 1.0), std::exp(-x), (x > 1.0 ? 1e-12 : 1e-14) * std::exp(-x)) << x;
  }
  EXPECT_EQ(decay(1e9, 0.5), 0.0);
  EXPECT_DOUBLE_EQ(decay(0.02, 0.5), decay(0.01, 0.25));
}

TEST(WheelSlipError, DerivativeByTheErrorsIsThatOfFiniteDifferences) {
  const Three model;
  const OdometryStep step = accelerating_step();
  Eigen::Matrix<double, 6, 1> error;
  error << 0.01, -0.02, 0.005, 0.03, -0.01, 0.02;
  const auto rates = [&](const Eigen::Matrix<double, 6, 1>& e) -> Eigen::Vector3d {
    return model.corrected(step, e).rates.vector();
  };
  const auto numeric = test::numeric_jacobian<3, 6>(rates, error);
  EXPECT_LT((model.corrected(step, error).by_error - numeric).norm(), 1e-9);
}

TEST(WheelSlipError, TakesOutTheErrorsThatItKnows) {
  const BodyRates truth{0.20, -0.05, 0.6};
  const BodyRates before{0.18, -0.04, 0.55};
  const BodyRates earlier{0.16, -0.03, 0.50};
  Eigen::Matrix<double, 6, 1> error;
  error << 0.010, -0.008, 0.004, 0.02, 0.03, -0.01;
  const BodyRates measured = measured_with(error, truth, before, 0.02);
  const BodyRates measured_before = measured_with(error, before, earlier, 0.02);
  const auto corrected = Three().corrected({measured, measured_before, 0.02, 0.02}, error);
  const double uncorrected = (measured.vector() - truth.vector()).norm();
  EXPECT_GT(uncorrected, 0.01);
  // Measured speeds stand for the true ones: what is left is of second order.
  EXPECT_LT((corrected.rates.vector() - truth.vector()).norm(), 0.05 * uncorrected);
}

TEST(WheelSlipError, StandingRobotHasNoErrorsButWhiteNoise) {
  Eigen::Matrix<double, 6, 1> error = Eigen::Matrix<double, 6, 1>::Constant(0.05);
  const auto corrected = Three().corrected({{}, {}, 0.02, 0.02}, error);
  EXPECT_EQ(corrected.rates.vector().norm(), 0.0);
  EXPECT_EQ(corrected.by_error.norm(), 0.0);
  const Eigen::Matrix3d expected = geometry().rate_covariance(0.006) * 0.02;
  EXPECT_LT((corrected.white_intensity - expected).norm(), 1e-12);
}

TEST(WheelSlipError, WhatIsNotLearntIsNoiseInProportionToTheAcceleration) {
  const OdometryStep step = accelerating_step();
  const auto extra = [&](double unlearnt_s) -> Eigen::Matrix3d {
    const Three model(geometry(), {.rim_noise_mps = 0.0, .unlearnt_slip_sigma_s = unlearnt_s});
    return model.corrected(step, Three::ErrorState::Zero()).white_intensity;
  };
  EXPECT_EQ(extra(0.0).norm(), 0.0);
  EXPECT_LT((extra(0.02) - 4.0 * extra(0.01)).norm(), 1e-15);
  // Of each wheel (sigma a)^2 for a tenth of a second, in the direction in which it drives.
  const WheelValues acceleration = (geometry().rim_speeds_mps(step.mean_rates) -
                                    geometry().rim_speeds_mps(step.previous_rates)) /
                                   step.interval_s;
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d rates = geometry().body_rates(WheelValues::Unit(3, i)).vector();
    expected += std::pow(0.01 * acceleration[i], 2) * 0.1 * rates * rates.transpose();
  }
  EXPECT_LT((extra(0.01) - expected).norm(), 1e-12 * expected.norm());
  EXPECT_THROW(Three(geometry(), {.unlearnt_slip_sigma_s = -0.01}), std::invalid_argument);
}

/// Mean white intensity of a model's wheels, (m/s)^2 s, while all rims change their speed by the
/// same acceleration; as the encoders measure it, whose noise is the model's, in intervals of two
/// lengths by turns. Means over time, as the motion's covariance adds up.
double mean_rim_intensity_m2ps(const Three& model, double acceleration_mps2, double long_s,
                               double short_s) {
  test::RandomStream random(31);
  const double walk = model.parameters().rim_noise_mps * std::sqrt(0.02);
  constexpr int kIntervals = 40000;
  double sum = 0.0;
  double time_s = 0.0;
  BodyRates before;
  double before_s = 0.0;
  for (int k = 0; k < kIntervals; ++k) {
    const double length_s = k % 2 == 0 ? long_s : short_s;
    // Faster and slower by turns: the square of the acceleration stays.
    const double mean_mps = k % 2 == 0 ? 0.0 : acceleration_mps2 * 0.5 * (long_s + short_s);
    WheelValues rims(3);
    for (int i = 0; i < 3; ++i) rims[i] = mean_mps + walk / std::sqrt(length_s) * random.normal();
    const BodyRates rates = geometry().body_rates(rims);
    if (k > 0) {
      const auto corrected =
          model.corrected({rates, before, length_s, length_s, before_s}, Three::ErrorState::Zero());
      // Rims of white noise w each have rates of w G G^T; G has an inverse.
      const Eigen::Matrix3d g = geometry().rims_by_rates();
      sum += length_s * (g * corrected.white_intensity * g.transpose()).trace() / 3.0;
      time_s += length_s;
    }
    before = rates;
    before_s = length_s;
  }
  return sum / time_s;
}

TEST(WheelSlipError, NoiseOfTheEncodersIsNoAcceleration) {
  const WheelSlipParameters parameters{.unlearnt_slip_sigma_s = 0.01};
  const double rim_m2ps = std::pow(parameters.rim_noise_mps, 2) * 0.02;
  const auto excess = [&](double long_s, double short_s) {
    return mean_rim_intensity_m2ps(Three(geometry(), parameters), 0.0, long_s, short_s) - rim_m2ps;
  };
  const auto encoders_part = [&](double long_s, double short_s) {
    const double acceleration2 =
        rim_m2ps * (1.0 / long_s + 1.0 / short_s) / std::pow(0.5 * (long_s + short_s), 2);
    return std::pow(parameters.unlearnt_slip_sigma_s, 2) * 0.1 * acceleration2;
  };
  // What is left of z^2 - 1 where it is positive, z normal: sqrt(2 / (pi e)) = 0.484 in the mean.
  EXPECT_NEAR(excess(0.02, 0.02), 0.484 * encoders_part(0.02, 0.02), 0.02 * rim_m2ps);
  EXPECT_NEAR(excess(0.015, 0.005) / encoders_part(0.015, 0.005), 0.484, 0.02);
  EXPECT_LT(excess(0.02, 0.02), 1.3 * rim_m2ps) << "2.5 if the encoders' part stayed";
}

TEST(WheelSlipError, EncodersWithoutNoiseShowAnAccelerationAsItIs) {
  const Three model(geometry(), {.rim_noise_mps = 0.0, .unlearnt_slip_sigma_s = 0.01});
  for (const double short_s : {0.02, 0.005}) {
    EXPECT_NEAR(mean_rim_intensity_m2ps(model, 4.0, 0.02, short_s), std::pow(0.01 * 4.0, 2) * 0.1,
                1e-12);
  }
}

TEST(WheelSlipError, NoiseOfTheEncodersHidesNoAcceleration) {
  const Three model(geometry(), {.unlearnt_slip_sigma_s = 0.01});
  const double expected = std::pow(0.01 * 4.0, 2) * 0.1 + std::pow(0.006, 2) * 0.02;
  for (const double short_s : {0.02, 0.005}) {
    EXPECT_NEAR(mean_rim_intensity_m2ps(model, 4.0, 0.02, short_s), expected, 0.03 * expected);
  }
}

TEST(WheelSlipError, SlipIsTakenOutOfIntervalsOfAnyLength) {
  // Evenly faster and faster: each mean rate is that of the interval's middle.
  const BodyRates acceleration{3.0, -2.0, 8.0};
  const auto rates_at = [&](double t_s) { return BodyRates::from(t_s * acceleration.vector()); };
  Eigen::Matrix<double, 6, 1> error;
  error << 0.0, 0.0, 0.0, 0.02, 0.03, -0.01;
  const auto measured = [&](double from_s, double to_s) {
    const double middle_s = 0.5 * (from_s + to_s);
    return measured_with(error, rates_at(middle_s), rates_at(middle_s - 1.0), 1.0);
  };
  const auto corrected =
      Three().corrected({measured(0.015, 0.020), measured(0.0, 0.015), 0.005, 0.005, 0.015}, error);
  EXPECT_LT((corrected.rates.vector() - rates_at(0.0175).vector()).norm(), 1e-12);
}

TEST(WheelSlipError, DelayedFusionTellsHowLongTheIntervalBeforeWas) {
  const Three model(geometry(), {.unlearnt_slip_sigma_s = 0.01});
  const PoseCovariance sure = Eigen::Vector3d(1e-6, 1e-6, 1e-4).asDiagonal();
  DelayedFusion<AboutEstimate, Three>::Settings settings;
  settings.filter.odometry_error = model;
  DelayedFusion<AboutEstimate, Three> fusion(settings);
  SlipFilter filter(settings.filter);
  Timestamp time = std::chrono::seconds(1);
  fusion.start(time, {}, sure);
  filter.start({}, sure);
  BodyRates before;
  double before_s = 0.0;
  for (const int length_ms : {15, 5, 20, 10}) {
    const Timestamp to = time + std::chrono::milliseconds(length_ms);
    const double length_s = to_seconds(to - time);
    const BodyRates rates{before.u_mps + 0.05, 0.0, 0.1};
    if (before_s == 0.0) {
      filter.predict({rates, rates, length_s, length_s});
    } else {
      filter.predict({rates, before, length_s, length_s, before_s});
    }
    fusion.add_odometry({time, to, rates, {}});
    time = to;
    before = rates;
    before_s = length_s;
  }
  EXPECT_EQ(fusion.filter().state().covariance, filter.state().covariance);
}

TEST(WheelSlipError, SlipTimesAreAStationaryGaussMarkovProcess) {
  const Three model(geometry(), {0.02, 0.03, 0.7, 0.006});
  OdometryStep step = accelerating_step();
  auto covariance = model.initial_covariance();
  for (int i = 0; i < 200; ++i) {
    step.dt_s = i % 2 == 0 ? 0.02 : 0.005;
    const auto change = model.transition(step);
    covariance =
        change.transition * covariance * change.transition.transpose() + change.noise_covariance;
  }
  EXPECT_LT((covariance - model.initial_covariance()).norm(), 1e-12);
  // Correlation between two times: e^(-dt / correlation time).
  step.dt_s = 0.02;
  EXPECT_NEAR(model.transition(step).transition(5, 5), std::exp(-0.02 / 0.7), 1e-12);
  EXPECT_EQ(model.transition(step).transition(2, 2), 1.0);
}

TEST(WheelSlipError, SplitIntervalEndsWithTheSameCovariance) {
  SlipFilter whole;
  whole.start({0.1, 0.2, 0.3}, Eigen::Vector3d(1e-6, 1e-6, 1e-4).asDiagonal());
  SlipFilter split = whole;
  OdometryStep step = accelerating_step();
  whole.predict(step);
  step.dt_s = 0.007;
  split.predict(step);
  step.dt_s = 0.013;
  split.predict(step);
  EXPECT_LT(pose_difference(whole.state().pose, split.state().pose).norm(), 1e-12);
  const auto& expected = whole.state().covariance;
  EXPECT_LT((split.state().covariance - expected).norm(), 0.01 * expected.norm());
}

TEST(WheelSlipError, FilterFindsTheScalesOfTheWheels) {
  test::RandomStream random(12);
  Eigen::Matrix<double, 6, 1> error = Eigen::Matrix<double, 6, 1>::Zero();
  error.head<3>() << 0.015, -0.020, 0.010;
  SlipFilter filter;
  filter.start({}, Eigen::Vector3d(1e-6, 1e-6, 1e-4).asDiagonal());
  const PoseCovariance r = Eigen::Vector3d(4e-6, 4e-6, 4e-4).asDiagonal();
  PlanarPose truth;
  BodyRates before_measured;
  for (int k = 1; k <= 3000; ++k) {
    const double t = 0.02 * k;
    const BodyRates rates{0.3 * std::sin(0.4 * t), 0.3 * std::cos(0.7 * t),
                          0.5 * std::sin(0.3 * t)};
    const BodyRates measured = measured_with(error, rates, rates, 0.02);
    truth = moved(truth, rates, 0.02);
    filter.predict({measured, before_measured, 0.02, 0.02});
    before_measured = measured;
    if (k % 2 != 0) continue;
    const Eigen::Vector3d noise = random.normal(r);
    filter.correct(
        {truth.x_m + noise.x(), truth.y_m + noise.y(), wrap_angle(truth.heading_rad + noise.z())},
        r);
  }
  for (int i = 0; i < 3; ++i) {
    const double sigma = std::sqrt(filter.state().covariance(3 + i, 3 + i));
    EXPECT_LT(sigma, 0.004);
    EXPECT_NEAR(filter.state().odometry_error[i], error[i], 3.0 * sigma) << i;
  }
}

TEST(WheelSlipError, FourWheelsOnOneRobot) {
  constexpr double kPi = std::numbers::pi;
  const auto four = WheelGeometry::four_wheel(Eigen::Vector4d(0.25, 0.75, 1.25, 1.75) * kPi, 0.085);
  const WheelSlipError<4> model(four, {});
  const OdometryStep step = accelerating_step();
  Eigen::Matrix<double, 8, 1> error = Eigen::Matrix<double, 8, 1>::Constant(0.01);
  const auto rates = [&](const Eigen::Matrix<double, 8, 1>& e) -> Eigen::Vector3d {
    return model.corrected(step, e).rates.vector();
  };
  const auto numeric = test::numeric_jacobian<3, 8>(rates, error);
  EXPECT_LT((model.corrected(step, error).by_error - numeric).norm(), 1e-9);
  // The same scale of all wheels is that of all rates.
  error.tail<4>().setZero();
  EXPECT_LT((model.corrected(step, error).rates.vector() - 0.99 * step.mean_rates.vector()).norm(),
            1e-12);
}

TEST(WheelSlipError, RefusesWhatIsNoRobot) {
  EXPECT_THROW(Three(WheelGeometry::differential(0.2), {}), std::invalid_argument);
  EXPECT_THROW(Three(geometry(), {-0.02, 0.03, 1.0, 0.006}), std::invalid_argument);
  EXPECT_THROW(Three(geometry(), {0.02, 0.03, 0.0, 0.006}), std::invalid_argument);
}

}  // namespace
}  // namespace nadir::fusion
