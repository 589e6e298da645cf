// The simulated rover as a base: its firmware overcomes friction, and it stops by itself.

#include "control_client/rover/rover_base.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <filesystem>
#include <vector>

#include "fusion/odometry.h"

namespace nadir::control_client {
namespace {

using fusion::Timestamp;
using namespace std::chrono_literals;

constexpr Timestamp kStart = 100s;

RoverBase base_with(EncoderKind encoders) {
  SimulationSettings settings;
  settings.encoders.kind = encoders;
  return {RoverRobot{}, settings, kStart, {}};
}

tracker::WireWheelCommand rates(double u_mps, double v_mps, double r_radps) {
  tracker::WireWheelCommand command;
  command.kind = tracker::WheelCommandKind::kBodyRates;
  command.valid_for_ns = Timestamp(100ms).count();
  command.body_rates = {u_mps, v_mps, r_radps};
  return command;
}

/// Commands every 20 ms for a time; all odometry of it.
std::vector<OdometryInterval> drive(RoverBase& base, const tracker::WireWheelCommand& command,
                                    Timestamp from, Timestamp to) {
  std::vector<OdometryInterval> all;
  std::vector<OdometryInterval> some;
  for (Timestamp time = from; time < to; time += 20ms) {
    base.command(command, time);
    base.take_odometry(time + 20ms, &some);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

TEST(RoverDescription, HasTheWheelsOfTheory) {
  const RobotModel robot(rover_description({}));
  const Eigen::Matrix3d b = RoverModel{}.wheel_matrix(0.0);
  EXPECT_LT((robot.drive() - b).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(RoverFile, OfTheDataIsTheDefault) {
  const RoverRobot read =
      load_rover_robot_file(std::filesystem::path(NADIR_DATA_DIR) / "robots/rover.yaml");
  const RoverRobot rover;
  EXPECT_EQ(read.name, rover.name);
  EXPECT_EQ(read.body.mass_kg, rover.body.mass_kg);
  EXPECT_EQ(read.body.inertia_kgm2, rover.body.inertia_kgm2);
  EXPECT_EQ(read.body.arm_m, rover.body.arm_m);
  EXPECT_EQ(read.losses.input_loss, rover.losses.input_loss);
  EXPECT_EQ(read.losses.friction_n, rover.losses.friction_n);
  EXPECT_EQ(read.firmware.observer_radps, rover.firmware.observer_radps);
  EXPECT_EQ(read.firmware.velocity_radps, rover.firmware.velocity_radps);
  EXPECT_EQ(read.max_speed_mps, rover.max_speed_mps);
  EXPECT_EQ(read.max_turn_rate_radps, rover.max_turn_rate_radps);
  EXPECT_EQ(read.tick_s, rover.tick_s);
}

TEST(RoverBase, ReachesTheCommandedRatesAgainstFriction) {
  RoverBase base = base_with(EncoderKind::kPerfect);
  drive(base, rates(0.3, -0.1, 0.4), kStart, kStart + 2s);
  const double heading_rad = base.plant().heading_rad();
  const Eigen::Vector3d v = base.plant().velocity();
  EXPECT_NEAR(std::cos(heading_rad) * v.x() + std::sin(heading_rad) * v.y(), 0.3, 0.006);
  EXPECT_NEAR(-std::sin(heading_rad) * v.x() + std::cos(heading_rad) * v.y(), -0.1, 0.006);
  EXPECT_NEAR(v.z(), 0.4, 0.02);
  EXPECT_FALSE(base.stopped_itself());
}

TEST(RoverBase, OdometryIsTheWayThatItWent) {
  RoverBase base = base_with(EncoderKind::kPerfect);
  fusion::PlanarPose odometry;
  for (const OdometryInterval& each : drive(base, rates(0.3, 0.1, 0.8), kStart, kStart + 4s)) {
    odometry = fusion::moved(odometry, each.mean_rates, fusion::to_seconds(each.to - each.from));
  }
  EXPECT_LT(fusion::pose_difference(odometry, base.plant().pose()).norm(), 1e-3);
  EXPECT_GT(base.plant().pose().position_m().norm(), 0.3);
}

TEST(RoverBase, StopsByItselfWhenACommandIsValidNoLonger) {
  RoverBase base = base_with(EncoderKind::kSlip);
  drive(base, rates(0.3, 0.0, 0.0), kStart, kStart + 1s);
  EXPECT_GT(base.plant().velocity().norm(), 0.25);
  std::vector<OdometryInterval> odometry;
  base.take_odometry(kStart + 3s, &odometry);
  EXPECT_TRUE(base.stopped_itself());
  EXPECT_LT(base.plant().velocity().norm(), 1e-3);
}

TEST(RoverBase, TakesRimSpeedsAsTheRatesThatTheyAreOf) {
  RoverBase by_rates = base_with(EncoderKind::kPerfect);
  RoverBase by_rims = base_with(EncoderKind::kPerfect);
  const RobotModel robot(rover_description({}));
  tracker::WireWheelCommand command = rates(0.0, 0.0, 0.0);
  command.kind = tracker::WheelCommandKind::kRimSpeeds;
  const WheelVector rims = robot.geometry().rim_speeds_mps({0.2, 0.1, 0.3});
  command.wheels.count = 3;
  for (int i = 0; i < 3; ++i) command.wheels.values.at(static_cast<std::size_t>(i)) = rims(i);
  drive(by_rims, command, kStart, kStart + 1s);
  drive(by_rates, rates(0.2, 0.1, 0.3), kStart, kStart + 1s);
  EXPECT_LT(fusion::pose_difference(by_rims.plant().pose(), by_rates.plant().pose()).norm(), 1e-9);
}

}  // namespace
}  // namespace nadir::control_client
