// The simulated robot, its wheels and its camera, each against what is known of it in closed form.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "control_client/simulation/encoders.h"
#include "control_client/simulation/faults.h"
#include "control_client/simulation/plant.h"
#include "control_client/simulation/random_stream.h"
#include "control_client/simulation/vision_feed.h"

namespace nadir::control_client {
namespace {

TEST(RandomStream, IsSplitMix64) {
  // First outputs of SplitMix64 from the state 1234567, as its authors publish them.
  RandomStream stream(1234566 / 1000003, static_cast<RandomPurpose>(1234567 - 1000003));
  EXPECT_EQ(stream.next(), 6457827717110365317ULL);
  EXPECT_EQ(stream.next(), 3203168211198807973ULL);
  EXPECT_EQ(stream.next(), 9817491932198370423ULL);
}

TEST(RandomStream, StreamsOfARunDiffer) {
  std::set<std::uint64_t> first;
  for (const auto purpose : {RandomPurpose::kWheelNoise, RandomPurpose::kVision,
                             RandomPurpose::kSlip, RandomPurpose::kPixelCounts}) {
    for (std::uint64_t seed = 1000; seed < 1040; ++seed) {
      first.insert(RandomStream(seed, purpose).next());
    }
  }
  EXPECT_EQ(first.size(), 160U);
}

TEST(RandomStream, NormalNumbersHaveTheirMoments) {
  RandomStream stream(1, RandomPurpose::kVision);
  constexpr int kCount = 200000;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double x = stream.normal();
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 4.0 / std::sqrt(kCount));
  EXPECT_NEAR(squares / kCount, 1.0, 4.0 * std::sqrt(2.0 / kCount));
}

class SimulatedPlant : public testing::Test {
 protected:
  RobotModel model_{RobotParameters{}};
};

// Without turning each direction is a first-order lag: u = u_end (1 - exp(-d t)).
TEST_F(SimulatedPlant, StartsLikeAFirstOrderLag) {
  Plant plant(model_, Eigen::Vector3d(1.0, 2.0, 0.5));
  const WheelVector forwards_v = Eigen::Vector3d(0.0, 3.0, -3.0);
  const double d = model_.damping_per_s()(0, 0);
  const double end_mps = (model_.input() * forwards_v).x() / d;
  double mean_mps = 0.0;
  for (int i = 0; i < 40; ++i) {
    plant.advance(forwards_v, 0.005);
    mean_mps +=
        fusion::BodyRates(model_.geometry().body_rates(plant.mean_rim_speeds_mps())).u_mps / 40;
  }
  const double way_m = end_mps * (0.2 - (1.0 - std::exp(-d * 0.2)) / d);
  EXPECT_NEAR(plant.body_rates().x(), end_mps * (1.0 - std::exp(-d * 0.2)), 1e-9);
  EXPECT_NEAR(mean_mps * 0.2, way_m, 1e-9);
  EXPECT_LT((plant.pose() -
             Eigen::Vector3d(1.0 + way_m * std::cos(0.5), 2.0 + way_m * std::sin(0.5), 0.5))
                .norm(),
            1e-9);
}

TEST_F(SimulatedPlant, ItsRuleIsOfFourthOrder) {
  const WheelVector turning_v = Eigen::Vector3d(6.0, -2.0, 3.0);
  const auto end = [&](double step_s) {  // one Runge-Kutta step each call
    Plant plant(model_, Eigen::Vector3d::Zero());
    for (int i = 0; i < static_cast<int>(std::lround(0.4 / step_s)); ++i) {
      plant.advance(turning_v, step_s);
    }
    return plant.pose();
  };
  const Eigen::Vector3d exact = end(0.0001);
  const double coarse = (end(0.001) - exact).norm();
  EXPECT_LT(coarse, 1e-9);
  EXPECT_GT(exact.z(), 1.0);  // it did turn
}

TEST_F(SimulatedPlant, CreepMovesTheBodyAndNotTheWheels) {
  Plant plant(model_, Eigen::Vector3d::Zero());
  const WheelVector none_v = WheelVector::Zero(3);
  plant.advance(none_v, 1.0, {Eigen::Vector2d::Zero(), {0.02, -0.01}});
  EXPECT_LT((plant.pose() - Eigen::Vector3d(0.02, -0.01, 0.0)).norm(), 1e-12);
  EXPECT_EQ(plant.mean_rim_speeds_mps().norm(), 0.0);
}

TEST(CableDrag, PullsOnlyWhenTaut) {
  const CableDrag cable{{-1.0, 0.0}, 1.1, 2.0, 0.1};
  EXPECT_EQ(cable.at({0.05, 0.0}).creep_world_mps.norm(), 0.0);
  const Disturbance pull = cable.at({0.3, 0.0});
  EXPECT_NEAR(pull.creep_world_mps.x(), -0.1 * 0.2, 1e-12);
  EXPECT_NEAR(pull.acceleration_world_mps2.x(), -2.0 * 0.2, 1e-12);
}

TEST(Encoders, WhiteNoiseHasItsVarianceAtAnyRate) {
  for (const double interval_s : {0.02, 0.005}) {
    EncoderParameters parameters;
    parameters.kind = EncoderKind::kWhite;
    Encoders encoders(parameters, 3, 7);
    double squares = 0.0;
    constexpr int kCount = 20000;
    for (int i = 0; i < kCount; ++i) {
      const WheelVector zero = WheelVector::Zero(3);
      squares += encoders.measured_rim_speeds_mps(zero, interval_s).squaredNorm();
    }
    const double expected = 0.02 * 0.02 * 0.02 / interval_s;
    EXPECT_NEAR(squares / (3 * kCount) / expected, 1.0, 4.0 * std::sqrt(2.0 / (3 * kCount)));
  }
}

// The slip time is a Gauss-Markov process around its mean; under constant acceleration the report's
// excess over the truth, less scale error and white noise, shows its mean and deviation.
TEST(Encoders, SlipGrowsWithAcceleration) {
  constexpr int kRuns = 4000;
  double sum = 0.0;
  double squares = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    EncoderParameters parameters;
    parameters.scale_deviation = 0.0;
    parameters.white_mps = 0.0;
    Encoders encoders(parameters, 3, static_cast<std::uint64_t>(run));
    WheelVector speeds_mps = Eigen::Vector3d::Zero();
    WheelVector measured_mps;
    for (int i = 0; i < 30; ++i) {
      speeds_mps.array() += 0.02;  // 1 m/s^2
      measured_mps = encoders.measured_rim_speeds_mps(speeds_mps, 0.02);
    }
    const double slip_s = measured_mps(0) - speeds_mps(0);
    sum += slip_s;
    squares += slip_s * slip_s;
  }
  const double mean = sum / kRuns;
  EXPECT_NEAR(mean, 0.01, 4.0 * 0.02 / std::sqrt(kRuns));
  EXPECT_NEAR(std::sqrt(squares / kRuns - mean * mean), 0.02, 4.0 * 0.02 / std::sqrt(2.0 * kRuns));
}

// Switching the slip on leaves the white noise as it was.
TEST(Encoders, WhiteNoiseIsTheSameWithAndWithoutSlip) {
  EncoderParameters white;
  white.kind = EncoderKind::kWhite;
  EncoderParameters slipping;
  slipping.kind = EncoderKind::kSlip;
  slipping.white_mps = white.matched_mps;
  Encoders of_white(white, 3, 2000);
  Encoders of_slipping(slipping, 3, 2000);
  // At rest there is nothing to scale and no acceleration to slip under.
  const WheelVector rest = WheelVector::Zero(3);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(of_white.measured_rim_speeds_mps(rest, 0.005),
              of_slipping.measured_rim_speeds_mps(rest, 0.005));
  }
}

TEST(VisionFeed, VariancesAreThePapers) {
  EXPECT_EQ(pose_variances(7.0, 45.0), Eigen::Vector3d(1.5e-5, 1.9e-5, 6.2e-3));
  EXPECT_EQ(pose_variances(20.0, 29.9), Eigen::Vector3d(4.84e-6, 4.86e-6, 7.2e-3));
  EXPECT_EQ(pose_variances(40.0, 10.0), Eigen::Vector3d(1.96e-6, 2.21e-6, 7.2e-3));
}

TEST(VisionFeed, LosesDelaysAndLiesAsOftenAsItShould) {
  VisionParameters parameters;
  parameters.ticks_per_frame = 1;
  VisionFeed feed(parameters, 0.02, 11);
  constexpr int kFrames = 20000;
  int lost = 0;
  int outliers = 0;
  int delays[7] = {};
  int arrived = 0;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  int good = 0;
  const fusion::PlanarPose truth{0.1, -0.2, 3.1};
  for (int tick = 1; tick <= kFrames; ++tick) {
    const VisionFrame frame = feed.capture(tick, truth);
    lost += frame.is_lost ? 1 : 0;
    outliers += frame.is_outlier ? 1 : 0;
    ++delays[frame.arrival_tick - frame.capture_tick];
    if (!frame.is_outlier) {
      ++good;
      squares += fusion::pose_difference(frame.pose_world_robot, truth)
                     .cwiseAbs2()
                     .cwiseQuotient(frame.variances);
    }
    arrived += static_cast<int>(feed.arrivals(tick).size());
  }
  const auto near_share = [](int count, double share) {
    const double sigma = std::sqrt(share * (1.0 - share) * kFrames);
    return std::abs(count - share * kFrames) < 4.0 * sigma;
  };
  EXPECT_TRUE(near_share(lost, 0.10)) << lost;
  EXPECT_TRUE(near_share(outliers, 0.05)) << outliers;
  // 60 to 100 ms, rounded up to ticks of 20 ms: four or five ticks, half of each.
  EXPECT_TRUE(near_share(delays[4], 0.5)) << delays[4];
  EXPECT_EQ(delays[4] + delays[5], kFrames);
  EXPECT_LE(kFrames - lost - arrived, 5);  // but for those on the way
  const double tolerance = 4.0 * std::sqrt(2.0 / good);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(squares(i) / good, 1.0, tolerance);
}

TEST(VisionFeed, BurstsAndBlackoutsTakeTheirTime) {
  VisionParameters parameters;
  parameters.burst_loss = BurstLoss{0.1, 0.4};
  VisionFeed feed(parameters, 0.02, 3);
  int lost = 0;
  int bursts = 0;
  bool in_burst = false;
  constexpr int kFrames = 50000;
  for (int i = 1; i <= kFrames; ++i) {
    const bool is_lost = feed.capture(2 * i, {}).is_lost;
    lost += is_lost ? 1 : 0;
    bursts += is_lost && !in_burst ? 1 : 0;
    in_burst = is_lost;
  }
  EXPECT_NEAR(static_cast<double>(lost) / kFrames, 0.10, 0.01);
  EXPECT_NEAR(0.04 * lost / bursts, 0.4, 0.03);

  parameters.burst_loss.reset();
  parameters.loss = 0.0;
  parameters.blackout = Blackout{1.0, 2.0};
  VisionFeed dark(parameters, 0.02, 3);
  for (int tick = 2; tick <= 200; tick += 2) {
    const double time_s = 0.02 * tick;
    EXPECT_EQ(dark.capture(tick, {}).is_lost, time_s >= 1.0 && time_s < 2.0) << time_s;
  }
}

}  // namespace
}  // namespace nadir::control_client
