#include "fusion/heading_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <limits>

#include "fusion/magnetic_heading.h"
#include "tests/fusion/random_stream.h"

namespace nadir::fusion {
namespace {

constexpr double kTick_s = 0.02;
constexpr double kMagnetometer_rad2 = 0.01;  // S1's Rn
constexpr auto kMagnetometer = HeadingSource::kMagnetometer;
constexpr auto kVision = HeadingSource::kVision;

HeadingFilterSettings without_gate() {
  HeadingFilterSettings settings;
  settings.gate_nis = 0.0;
  return settings;
}

HeadingFilter started(const HeadingFilterSettings& settings = {}) {
  HeadingFilter filter(settings);
  filter.start(0.0, kMagnetometer_rad2, 1e-4);
  return filter;
}

/// Standing still with a perfect gyro and these headings, for a time.
void stand(HeadingFilter& filter, double heading_rad, double duration_s) {
  for (double t = 0.0; t < duration_s; t += kTick_s) {
    filter.predict(0.0, kTick_s);
    filter.correct(kMagnetometer, heading_rad, kMagnetometer_rad2);
  }
}

TEST(MagneticHeading, IsExactHoweverTheRobotLeans) {
  const Eigen::Vector3d north_down(20.0, 0.0, 43.0);
  test::RandomStream random(3);
  for (int i = 0; i < 100; ++i) {
    const double yaw = random.uniform(-3.1, 3.1);  // clockwise from above: z points down
    const Tilt tilt{random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6)};
    const Eigen::Matrix3d body_to_world =
        (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(tilt.pitch_rad, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(tilt.roll_rad, Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    const Eigen::Vector3d measured = body_to_world.transpose() * north_down;
    EXPECT_NEAR(wrap_angle(magnetic_heading_rad(measured, tilt) + yaw), 0.0, 1e-12);
  }
}

TEST(MagneticHeading, WithThePrintedSignWouldBeFarOff) {
  // Theory 10, S1: 0.700 rad comes out as 0.106 with + mz sin(alpha).
  const Tilt tilt{0.15, -0.2};
  const Eigen::Matrix3d body_to_world =
      (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(tilt.pitch_rad, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(tilt.roll_rad, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  const Eigen::Vector3d field = body_to_world.transpose() * Eigen::Vector3d(20.0, 0.0, 43.0);
  EXPECT_NEAR(magnetic_heading_rad(field, tilt), -0.7, 1e-12);
  const Eigen::Vector2d level = level_field(field, tilt);
  const double printed_y = field.y() * std::cos(0.15) + field.z() * std::sin(0.15);
  EXPECT_GT(std::abs(std::atan2(-printed_y, level.x()) - 0.7), 0.3);
}

TEST(FieldGate, SeesIronByTheFieldsStrength) {
  const FieldGate gate{47.4, 0.15};
  EXPECT_TRUE(gate.passes({20.0, 0.0, 43.0}));
  EXPECT_FALSE(gate.passes({45.0, 20.0, 53.0}));
  EXPECT_FALSE(gate.passes({5.0, 0.0, 30.0}));
  EXPECT_FALSE(gate.passes({std::nan(""), 0.0, 43.0}));
  EXPECT_TRUE(FieldGate{}.passes({1e3, 0.0, 0.0})) << "no strength is known";
}

TEST(HeadingFilter, HasTheGainAndThePolesOfItsRiccatiEquation) {
  HeadingFilter filter = started(without_gate());
  stand(filter, 0.0, 60.0);
  EXPECT_NEAR(filter.gain()(0), 0.0749, 5e-5);
  EXPECT_NEAR(filter.gain()(1), -0.1360, 5e-5);
  EXPECT_NEAR(std::sqrt(filter.covariance()(0, 0)), 0.027, 5e-4);
  Eigen::Matrix2d step;
  step << 1.0, -kTick_s, 0.0, 1.0;
  const Eigen::Matrix2d closed =
      (Eigen::Matrix2d::Identity() - filter.gain() * Eigen::RowVector2d(1.0, 0.0)) * step;
  const auto poles = closed.eigenvalues().eval();
  EXPECT_NEAR(poles(0).real(), 0.961, 5e-4);
  EXPECT_NEAR(std::abs(poles(0).imag()), 0.035, 5e-4);
  // The discrete Riccati equation, for which that gain is the fixed point.
  const Eigen::Matrix2d& after = filter.covariance();
  Eigen::Matrix2d before = step * after * step.transpose();
  before(0, 0) += 0.01 * kTick_s * kTick_s;
  before(1, 1) += 0.01 * kTick_s;
  const Eigen::Vector2d gain = before.col(0) / (before(0, 0) + kMagnetometer_rad2);
  EXPECT_LT((gain - filter.gain()).norm(), 1e-9);
}

struct Nees {
  double heading_and_bias = 0.0;
  double heading_rms_rad = 0.0;
};

/// A robot that turns to and fro, its gyro and magnetometer as the filter models them, and a late
/// camera at 25 Hz if it has a variance. Mean over runs at the end of each.
Nees monte_carlo(double vision_rad2) {
  constexpr int kRuns = 200;
  Nees result;
  for (int run = 0; run < kRuns; ++run) {
    test::RandomStream random(static_cast<std::uint64_t>(run) + 100);
    HeadingFilter filter(without_gate());
    double heading = 3.0;
    double bias = 0.01 * random.normal();
    filter.start(heading + 0.1 * random.normal(), 0.01, 1e-4);
    double before_last = heading;
    double last = heading;
    for (int tick = 1; tick <= 300; ++tick) {
      const double rate = 2.0 * std::sin(0.05 * tick);
      before_last = last;
      last = heading;
      heading += rate * kTick_s;
      filter.predict(rate + bias + 0.1 * random.normal(), kTick_s);
      bias += std::sqrt(0.01 * kTick_s) * random.normal();
      filter.correct(kMagnetometer, heading + 0.1 * random.normal(), 0.01);
      if (vision_rad2 > 0.0 && tick % 2 == 0) {
        filter.correct(kVision, before_last + std::sqrt(vision_rad2) * random.normal(), vision_rad2,
                       2 * kTick_s);
      }
    }
    const Eigen::Vector2d error(wrap_angle(filter.heading_rad() - heading),
                                filter.bias_radps() - bias);
    result.heading_and_bias += error.dot(filter.covariance().inverse() * error) / kRuns;
    result.heading_rms_rad += error(0) * error(0) / kRuns;
  }
  result.heading_rms_rad = std::sqrt(result.heading_rms_rad);
  return result;
}

TEST(HeadingFilter, KnowsHowWrongItIs) {
  const Nees nees = monte_carlo(0.0);
  // 95 % of chi-square with 400 degrees of freedom, by 200 runs.
  EXPECT_GT(nees.heading_and_bias, 1.73);
  EXPECT_LT(nees.heading_and_bias, 2.29);
  EXPECT_NEAR(nees.heading_rms_rad, 0.027, 0.004);
}

TEST(HeadingFilter, VisionHeadingsAreOneMoreMeasurement) {
  const Nees nees = monte_carlo(3e-4);
  // A late frame knows of noise that the filter has counted already, so it may be too careful.
  EXPECT_GT(nees.heading_and_bias, 1.2);
  EXPECT_LT(nees.heading_and_bias, 2.29);
  EXPECT_LT(nees.heading_rms_rad, 0.017);
}

TEST(HeadingFilter, LearnsTheBias) {
  HeadingFilterSettings settings = without_gate();
  settings.bias_walk_rad2ps3 = 1e-6;
  HeadingFilter filter = started(settings);
  for (int tick = 0; tick < 3000; ++tick) {
    filter.predict(0.5 + 0.05, kTick_s);
    filter.correct(kMagnetometer, wrap_angle(0.5 * kTick_s * (tick + 1)), kMagnetometer_rad2);
  }
  EXPECT_NEAR(filter.bias_radps(), 0.05, 1e-3);
}

TEST(HeadingFilter, ALateHeadingIsComparedWithTheHeadingThen) {
  HeadingFilter filter = started(without_gate());
  for (int tick = 0; tick < 50; ++tick) filter.predict(2.0, kTick_s);
  const double now_rad = filter.heading_rad();
  // Between two samples, 0.05 s ago: 0.1 rad less.
  EXPECT_EQ(filter.correct(kVision, now_rad - 0.1, 1e-4, 0.05), HeadingVerdict::kAccepted);
  EXPECT_NEAR(filter.heading_rad(), now_rad, 1e-9);
  EXPECT_NEAR(filter.bias_radps(), 0.0, 1e-9);
}

TEST(HeadingFilter, AMagnetThatPassesIsNotBelieved) {
  HeadingFilter filter = started();
  stand(filter, 0.0, 5.0);
  for (int tick = 0; tick < 10; ++tick) {
    filter.predict(0.0, kTick_s);
    EXPECT_EQ(filter.correct(kMagnetometer, 0.6, kMagnetometer_rad2), HeadingVerdict::kGated);
  }
  EXPECT_NEAR(filter.heading_rad(), 0.0, 0.02);
  EXPECT_EQ(filter.correct(kMagnetometer, 0.0, kMagnetometer_rad2), HeadingVerdict::kAccepted);
}

TEST(HeadingFilter, ATurnThatNoGyroSawIsBelievedInTheEnd) {
  HeadingFilter filter = started();
  stand(filter, 0.0, 5.0);
  stand(filter, 1.0, 1.0);
  EXPECT_NEAR(filter.heading_rad(), 1.0, 0.15);
}

TEST(HeadingFilter, AMagnetIsNotBelievedWhileACameraSaysOtherwise) {
  HeadingFilter filter = started();
  stand(filter, 0.0, 5.0);
  int believed = 0;
  for (int tick = 0; tick < 500; ++tick) {
    filter.predict(0.0, kTick_s);
    if (tick % 2 == 0) filter.correct(kVision, 0.0, 3e-4, 0.08);
    const auto verdict = filter.correct(kMagnetometer, 0.6, kMagnetometer_rad2);
    believed += verdict == HeadingVerdict::kGated ? 0 : 1;
  }
  EXPECT_EQ(believed, 0);
  EXPECT_NEAR(filter.heading_rad(), 0.0, 1e-3);
}

TEST(HeadingFilter, RefusesWhatIsNoMeasurement) {
  HeadingFilter filter = started();
  stand(filter, 0.0, 5.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(filter.correct(kVision, nan, 1e-3), HeadingVerdict::kRefused);
  EXPECT_EQ(filter.correct(kVision, 0.0, 0.0), HeadingVerdict::kRefused);
  EXPECT_EQ(filter.correct(kVision, 0.0, nan), HeadingVerdict::kRefused);
  EXPECT_EQ(filter.correct(kVision, 0.0, 1e-3, -1.0), HeadingVerdict::kRefused);
  EXPECT_EQ(filter.correct(kVision, 0.0, 1e-3, 4.0), HeadingVerdict::kRefused) << "forgotten";
  EXPECT_NEAR(filter.heading_rad(), 0.0, 1e-3);
}

}  // namespace
}  // namespace nadir::fusion
