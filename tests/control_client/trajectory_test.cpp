#include "control_client/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "control_client/trajectory_file.h"
#include "tests/vision/input_error_line.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::control_client {
namespace {

constexpr double kPi = std::numbers::pi;

/// Velocity and acceleration are the derivatives, wherever neither jumps.
void expect_derivatives(const Trajectory& trajectory, const std::vector<double>& times_s,
                        double tolerance) {
  const double h = 1e-4;
  for (const double time_s : times_s) {
    const TrajectoryPoint before = trajectory.at(time_s - h);
    const TrajectoryPoint point = trajectory.at(time_s);
    const TrajectoryPoint after = trajectory.at(time_s + h);
    EXPECT_LT(((after.pose - before.pose) / (2.0 * h) - point.velocity_per_s).norm(), tolerance);
    EXPECT_LT(
        ((after.velocity_per_s - before.velocity_per_s) / (2.0 * h) - point.acceleration_per_s2)
            .norm(),
        tolerance);
  }
}

TEST(Trajectory, DerivativesOfTheStandardOnesAreExact) {
  for (const NamedTrajectory& named : standard_trajectories()) {
    SCOPED_TRACE(named.name);
    expect_derivatives(*named.trajectory, {0.7, 1.3, 3.1, 6.6}, 1e-6);
  }
}

TEST(Trajectory, SquareHasFourCornersAndTurnsAnEighthASide) {
  const auto square = standard_trajectory("square-turning");
  EXPECT_DOUBLE_EQ(square->duration_s(), 20.0);
  EXPECT_EQ(square->at(0.0).pose, Eigen::Vector3d(-0.25, -0.25, 0.0));
  EXPECT_LT((square->at(2.5).pose - Eigen::Vector3d(0.25, -0.25, kPi / 4.0)).norm(), 1e-12);
  EXPECT_LT((square->at(5.0).pose - Eigen::Vector3d(0.25, 0.25, kPi / 2.0)).norm(), 1e-12);
  EXPECT_LT((square->at(20.0).pose - Eigen::Vector3d(-0.25, -0.25, 2.0 * kPi)).norm(), 1e-12);
  EXPECT_NEAR(square->at(1.0).velocity_per_s.head<2>().norm(), 0.2, 1e-12);
}

TEST(Trajectory, CircleReachesItsRateAfterTheRamp) {
  const auto circle = standard_trajectory("circle");
  EXPECT_EQ(circle->at(0.0).velocity_per_s.norm(), 0.0);
  EXPECT_NEAR(circle->at(3.0).velocity_per_s.norm(), 0.25, 1e-12);
  // Angle t^2/4 until 2 s, then t - 1.
  EXPECT_LT((circle->at(1.0 + kPi).pose - Eigen::Vector3d(-0.25, 0.0, 0.0)).norm(), 1e-12);
  EXPECT_LT(
      (circle->at(1.0).pose - 0.25 * Eigen::Vector3d(std::cos(0.25), std::sin(0.25), 0.0)).norm(),
      1e-12);
}

TEST(Trajectory, RosesHaveTheirPetals) {
  const auto petals = [](const Trajectory& rose) {  // largest distances from the origin
    int count = 0;
    const double h = 0.01;
    for (double t = h; t < rose.duration_s(); t += h) {
      const double r = rose.at(t).pose.norm();
      if (r > rose.at(t - h).pose.norm() && r >= rose.at(t + h).pose.norm()) ++count;
    }
    return count;
  };
  EXPECT_EQ(petals(*standard_trajectory("rose3")), 6);  // three petals, each drawn twice
  EXPECT_EQ(petals(*standard_trajectory("rose4")), 8);
  EXPECT_NEAR(standard_trajectory("rose3")->duration_s(), 31.4159, 1e-4);
}

TEST(Trajectory, RestsBeforeAndAfter) {
  const auto square = standard_trajectory("square");
  EXPECT_EQ(square->at(-1.0).pose, square->at(0.0).pose);
  EXPECT_EQ(square->at(-1.0).velocity_per_s.norm(), 0.0);
  EXPECT_EQ(square->at(25.0).pose, square->at(20.0).pose);
  EXPECT_EQ(square->at(25.0).velocity_per_s.norm(), 0.0);
  EXPECT_EQ(standard_trajectory("no such"), nullptr);
}

TEST(Trajectory, ScaledInTimeItIsTheSamePathAtAnotherSpeed) {
  const auto circle = standard_trajectory("circle");
  const auto half = time_scaled(circle, 0.5);
  EXPECT_DOUBLE_EQ(half->duration_s(), 40.0);
  EXPECT_EQ(half->at(9.0).pose, circle->at(4.5).pose);
  expect_derivatives(*half, {1.0, 9.0}, 1e-6);
}

TEST(Trajectory, DemandTellsWhatTheRobotCannotDo) {
  const RobotModel model{RobotParameters{}};
  const auto circle = standard_trajectory("circle");
  EXPECT_LT(trajectory_demand(*circle, model).speed, 0.25);
  EXPECT_LT(trajectory_demand(*circle, model).voltage, 0.5);
  const auto racing = time_scaled(circle, 6.0);
  EXPECT_NEAR(trajectory_demand(*racing, model).speed, 6.0 * 0.25 / 1.18, 1e-3);
  EXPECT_GT(trajectory_demand(*racing, model).voltage, 1.0);
}

TEST(Waypoints, ArePassedAtRestWithinTheLimits) {
  const MotionLimits limits{0.4, 0.8, 1.0, 2.0};
  const std::vector<Eigen::Vector3d> points = {
      {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 0.5, kPi}};
  const auto trajectory = waypoint_trajectory(points, limits);
  double speed = 0.0;
  double acceleration = 0.0;
  double turn = 0.0;
  for (double t = 0.0; t <= trajectory->duration_s(); t += 0.001) {
    const TrajectoryPoint point = trajectory->at(t);
    speed = std::max(speed, point.velocity_per_s.head<2>().norm());
    acceleration = std::max(acceleration, point.acceleration_per_s2.head<2>().norm());
    turn = std::max(turn, std::abs(point.velocity_per_s.z()));
  }
  EXPECT_NEAR(speed, limits.speed_mps, 1e-4);
  EXPECT_LE(acceleration, limits.acceleration_mps2 + 1e-9);
  EXPECT_NEAR(turn, limits.turn_rate_radps, 1e-4);
  EXPECT_LT((trajectory->at(trajectory->duration_s()).pose - points.back()).norm(), 1e-12);
  expect_derivatives(*trajectory, {0.5, 2.0, trajectory->duration_s() - 1.0}, 1e-5);
}

TEST(Spline, IsSmoothThroughItsPoses) {
  const std::vector<double> times_s = {0.0, 1.0, 1.5, 3.0};
  const std::vector<Eigen::Vector3d> poses = {
      {0.0, 0.0, 0.0}, {0.3, 0.1, 0.5}, {0.5, 0.4, 1.0}, {0.0, 1.0, 2.0}};
  const auto spline = spline_trajectory(times_s, poses);
  const double h = 1e-9;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT((spline->at(times_s[i]).pose - poses[i]).norm(), 1e-12);
  }
  for (const double knot_s : {1.0, 1.5}) {
    const TrajectoryPoint before = spline->at(knot_s - h);
    const TrajectoryPoint after = spline->at(knot_s + h);
    EXPECT_LT((after.velocity_per_s - before.velocity_per_s).norm(), 1e-7);
    EXPECT_LT((after.acceleration_per_s2 - before.acceleration_per_s2).norm(), 1e-6);
  }
  EXPECT_LT(spline->at(0.0).velocity_per_s.norm(), 1e-12);
  EXPECT_LT(spline->at(3.0).velocity_per_s.norm(), 1e-12);
  expect_derivatives(*spline, {0.4, 1.2, 2.2}, 1e-5);
}

TEST(TrajectoryFile, ReadsPosesAndUnwrapsHeadings) {
  const vision::ScratchFolder folder;
  const auto file =
      folder.write("path.csv", "t_s,x_m,y_m,heading_rad\n10,0,0,3.0\n11,1,0,-3.0\n12,1,1,-2.5\n");
  const auto trajectory = load_trajectory(file);
  EXPECT_DOUBLE_EQ(trajectory->duration_s(), 2.0);
  EXPECT_NEAR(trajectory->at(1.0).pose.z(), 2.0 * kPi - 3.0, 1e-12);
}

TEST(TrajectoryFile, ReadsWaypoints) {
  const vision::ScratchFolder folder;
  const auto file = folder.write(
      "tour.yaml", "waypoints:\n  - {x_m: 0, y_m: 0}\n  - {x_m: 2, y_m: 1, heading_rad: 1}\n");
  EXPECT_LT((load_trajectory(file)->at(100.0).pose - Eigen::Vector3d(2.0, 1.0, 1.0)).norm(), 1e-12);
}

TEST(TrajectoryFile, SaysInOneLineWhatIsWrong) {
  const vision::ScratchFolder folder;
  const auto complaint = [&](const std::string& name, const std::string& text) {
    const auto file = folder.write(name, text);
    return vision::input_error_line([&] { load_trajectory(file); });
  };
  const std::string header = "t_s,x_m,y_m,heading_rad\n";
  EXPECT_NE(complaint("a.csv", header + "0,0,0,0\n1,nan,0,0\n").find("a.csv:3:3"),
            std::string::npos);
  EXPECT_NE(complaint("b.csv", header + "0,0,0,0\n0,1,0,0\n").find("does not rise"),
            std::string::npos);
  EXPECT_NE(complaint("c.csv", header + "0,0,0,0\n").find("two rows"), std::string::npos);
  EXPECT_NE(complaint("d.yaml", "waypoints:\n  - {x_m: 0, y_m: 0}\n").find("two waypoints"),
            std::string::npos);
  EXPECT_NE(complaint("e.txt", "").find(".csv or .yaml"), std::string::npos);
}

}  // namespace
}  // namespace nadir::control_client
