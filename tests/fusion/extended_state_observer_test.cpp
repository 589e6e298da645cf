#include "fusion/extended_state_observer.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace nadir::fusion {
namespace {

constexpr double kTick_s = 0.05;
constexpr double kMass_kg = 1.5;         // S4
constexpr double kInertia_kgm2 = 0.025;  // S4
const Eigen::Vector3d kInertia(kMass_kg, kMass_kg, kInertia_kgm2);

std::array<ObserverGains, 3> same(const ObserverGains& gains) { return {gains, gains, gains}; }

std::array<ObserverGains, 3> of_bandwidth(double radps) {
  return {gains_of_bandwidth(radps, kMass_kg), gains_of_bandwidth(radps, kMass_kg),
          gains_of_bandwidth(radps, kInertia_kgm2)};
}

TEST(ObserverStability, FlagsThePrintedGainsWithTheirPoles) {
  const ObserverGains printed{10.0, 0.2, 100.0};
  const ObserverStability moved = observer_stability(printed, kMass_kg);
  EXPECT_FALSE(moved.is_stable);
  EXPECT_NEAR(moved.routh_margin_per_s3, 2.0 - 66.7, 0.05);
  EXPECT_NEAR(moved.poles[0].real(), 0.29, 0.005);
  EXPECT_NEAR(moved.poles[0].imag(), 2.49, 0.005);
  const ObserverStability turned = observer_stability(printed, kInertia_kgm2);
  EXPECT_FALSE(turned.is_stable);
  EXPECT_NEAR(turned.poles[0].real(), 5.0, 0.05);
  EXPECT_NEAR(turned.poles[0].imag(), 13.2, 0.05);
  EXPECT_NE(turned.text().find("unstable"), std::string::npos);
  EXPECT_NE(moved.text().find("+0.29+2.49j"), std::string::npos) << moved.text();
}

TEST(ObserverStability, PassesSwappedGainsAndBandwidthForm) {
  EXPECT_TRUE(observer_stability({10.0, 100.0, 0.2}, kMass_kg).is_stable);
  const ObserverStability stability = observer_stability(gains_of_bandwidth(5.0, 2.0), 2.0);
  EXPECT_TRUE(stability.is_stable);
  EXPECT_NEAR(stability.routh_margin_per_s3, 9.0 * 125.0 - 125.0, 1e-9);
  for (const auto& pole : stability.poles) {
    EXPECT_NEAR(std::abs(pole + 5.0), 0.0, 1e-3);  // a triple root is known to eps^(1/3)
  }
}

TEST(ObserverStability, NeedsGainsAboveZero) {
  EXPECT_FALSE(observer_stability({10.0, 100.0, 0.0}, kMass_kg).is_stable);
  EXPECT_FALSE(observer_stability({-10.0, -100.0, 1.0}, kMass_kg).is_stable);
}

/// How errors of position, velocity and acceleration (disturbance / inertia) go from one corrected
/// tick to the next: columns by starting an observer with each of them, beside a body at rest.
Eigen::Matrix3d tick_of_errors(const ExtendedStateObserver& made, int axis) {
  const Eigen::Vector3d gain(made.correction_gains()(0, axis), made.correction_gains()(1, axis),
                             made.correction_gains()(2, axis) / kInertia[axis]);
  Eigen::Matrix3d a;
  a << 1.0, kTick_s, 0.5 * kTick_s * kTick_s, 0.0, 1.0, kTick_s, 0.0, 0.0, 1.0;
  return (Eigen::Matrix3d::Identity() - gain * Eigen::RowVector3d(1.0, 0.0, 0.0)) * a;
}

TEST(ExtendedStateObserver, HasTheExactPolesOfAnyGains) {
  for (const ObserverGains& gains :
       {ObserverGains{10.0, 100.0, 0.2}, ObserverGains{10.0, 0.2, 100.0},
        ObserverGains{12.0, 40.0, 60.0}}) {
    const ExtendedStateObserver observer(same(gains), kInertia, kTick_s);
    for (int axis = 0; axis < 3; axis += 2) {
      const Eigen::Matrix3d errors = tick_of_errors(observer, axis);
      for (const auto& s : observer_stability(gains, kInertia[axis]).poles) {
        const std::complex<double> z = std::exp(s * kTick_s);
        const Eigen::Matrix3cd at =
            z * Eigen::Matrix3cd::Identity() - errors.cast<std::complex<double>>();
        EXPECT_NEAR(std::abs(at.determinant()), 0.0, 1e-10);
      }
    }
  }
}

TEST(ExtendedStateObserver, InBandwidthFormHasTheGainsOfTheClosedForm) {
  for (const double w : {3.33, 5.0, 10.0, 40.0}) {
    const ExtendedStateObserver observer(of_bandwidth(w), kInertia, kTick_s);
    const double z = std::exp(-w * kTick_s);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d gain = observer.correction_gains().col(axis);
      EXPECT_NEAR(gain[0], 1.0 - z * z * z, 1e-12);
      EXPECT_NEAR(gain[1], 1.5 * (1.0 - z) * (1.0 - z) * (1.0 + z) / kTick_s, 1e-10);
      EXPECT_NEAR(gain[2], kInertia[axis] * std::pow((1.0 - z) / kTick_s, 2) * (1.0 - z), 1e-9);
    }
  }
}

TEST(ExtendedStateObserver, FindsConstantForcesExactlyWhereverTheHeadingWraps) {
  ExtendedStateObserver observer(of_bandwidth(10.0), kInertia, kTick_s);
  observer.start({0.2, 0.3, 3.0});
  const Eigen::Vector3d commanded(0.6, -0.3, 0.004);
  const Eigen::Vector3d hidden(-0.35, 0.1, 0.002);
  const Eigen::Vector3d acceleration = (commanded + hidden).cwiseQuotient(kInertia);
  for (int k = 1; k <= 120; ++k) {
    const double t = kTick_s * k;
    observer.predict(commanded);
    const Eigen::Vector3d way = 0.5 * t * t * acceleration;
    observer.correct({0.2 + way.x(), 0.3 + way.y(), wrap_angle(3.0 + way.z())});
  }
  const double end_s = 120 * kTick_s;
  EXPECT_LT((observer.disturbance() - hidden).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((observer.velocity() - end_s * acceleration).cwiseAbs().maxCoeff(), 1e-9);
}

/// The velocity that the continuous observer reads at a constant speed of 1, if it is integrated in
/// small steps while each measured position is held for a tick.
double velocity_of_held_positions(double bandwidth_radps) {
  const ObserverGains gains = gains_of_bandwidth(bandwidth_radps, 1.0);
  constexpr int kSteps = 1000;
  const double h = kTick_s / kSteps;
  double position = 0.0;
  double velocity = 1.0;
  double disturbance = 0.0;
  for (int k = 1; k <= 400; ++k) {
    for (int step = 0; step < kSteps; ++step) {
      const double error = k * kTick_s - position;
      const double acceleration = disturbance + gains.velocity_per_s2 * error;
      position += h * (velocity + gains.position_per_s * error);
      velocity += h * acceleration;
      disturbance += h * gains.disturbance_n_per_m_per_s * error;
    }
  }
  return velocity;
}

TEST(ExtendedStateObserver, ReadsAConstantVelocityRightWhichHeldPositionsDoNot) {
  for (const double w : {10.0 / 3.0, 5.0, 10.0}) {
    // Too low by lv T^2 / 12 = (w T)^2 / 4: at the tick's ends the held error's integral is lowest.
    EXPECT_NEAR(1.0 - velocity_of_held_positions(w), 0.25 * std::pow(w * kTick_s, 2), 0.006) << w;
    ExtendedStateObserver observer(of_bandwidth(w), kInertia, kTick_s);
    observer.start({});
    for (int k = 1; k <= 400; ++k) {
      observer.predict(Eigen::Vector3d::Zero());
      observer.correct({k * kTick_s, 0.0, 0.0});
    }
    EXPECT_NEAR(observer.velocity().x(), 1.0, 1e-9) << w;
  }
}

TEST(ExtendedStateObserver, DivergesWithThePrintedGains) {
  ExtendedStateObserver observer(same({10.0, 0.2, 100.0}), kInertia, kTick_s);
  observer.start({});
  observer.correct({1e-3, 1e-3, 1e-3});
  for (int k = 0; k < 200; ++k) {
    observer.predict(Eigen::Vector3d::Zero());
    observer.correct({});
  }
  EXPECT_GT(observer.disturbance().cwiseAbs().maxCoeff(), 1.0);
}

}  // namespace
}  // namespace nadir::fusion
