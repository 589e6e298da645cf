#include "control_client/robot_model.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace nadir::control_client {
namespace {

const RobotModel& omni3() {
  static const RobotModel kModel{RobotParameters{}};
  return kModel;
}

RobotParameters four_wheels() {
  RobotParameters robot;
  robot.wheels.clear();
  for (const double angle_deg : {60.0, 135.0, -135.0, -60.0}) {
    robot.wheels.push_back({angle_deg * std::numbers::pi / 180.0, 0.08});
  }
  return robot;
}

TEST(RobotModel, DriveMatrixIsThePapers) {
  const double cos30 = std::sqrt(3.0) / 2.0;
  Eigen::Matrix3d expected;
  expected << 0.0, cos30, -cos30, -1.0, 0.5, 0.5, 0.07, 0.07, 0.07;
  EXPECT_LT((omni3().drive() - expected).cwiseAbs().maxCoeff(), 1e-15);
  const Eigen::Matrix3d squared = omni3().drive() * omni3().drive().transpose();
  const Eigen::Matrix3d diagonal = Eigen::Vector3d(1.5, 1.5, 3.0 * 0.07 * 0.07).asDiagonal();
  EXPECT_LT((squared - diagonal).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(RobotModel, MatricesHaveTheValuesOfTheParameterSet) {
  const Eigen::Matrix3d g = Eigen::Vector3d(1.13406, 1.13406, 1.32846).asDiagonal();
  const Eigen::Matrix3d d = Eigen::Vector3d(6.7162, 6.7162, 14.047).asDiagonal();
  Eigen::Matrix3d bu;
  bu << 0.0, 0.7627, -0.7627, -0.8807, 0.4403, 0.4403, 13.157, 13.157, 13.157;
  EXPECT_LT((omni3().inertia_ratio() - g).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_LT((omni3().damping_per_s() - d).cwiseAbs().maxCoeff(), 5e-4);
  EXPECT_LT((omni3().input() - bu).cwiseAbs().maxCoeff(), 5e-4);
}

TEST(RobotModel, FullVoltageGivesThePublishedLimits) {
  const auto steady = [](double e1_v, double e2_v, double e3_v) -> Eigen::Vector3d {
    const WheelVector voltages_v = Eigen::Vector3d(e1_v, e2_v, e3_v);
    return omni3().damping_per_s().inverse() * (omni3().input() * voltages_v);
  };
  EXPECT_NEAR(steady(6, 6, 6).z(), 16.86, 2e-3);
  EXPECT_NEAR(steady(-6, 3, 3).y(), 1.180, 1e-3);
  EXPECT_NEAR(steady(0, 6, -6).x(), 1.363, 1e-3);
  // Each of them is an equilibrium of the dynamics themselves.
  const WheelVector full_v = Eigen::Vector3d(6, 6, 6);
  EXPECT_LT(omni3().acceleration(steady(6, 6, 6), full_v).norm(), 1e-12);
}

// Newton and Euler for the body and each motor's own equation, put together again.
void expect_body_and_motors_agree(const RobotModel& model) {
  const RobotParameters& robot = model.parameters();
  const MotorParameters& motor = robot.motor;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d q(uniform(random), uniform(random), 8.0 * uniform(random));
    WheelVector voltages_v(model.wheel_count());
    for (double& voltage_v : voltages_v) voltage_v = 6.0 * uniform(random);
    const Eigen::Vector3d q_dot = model.acceleration(q, voltages_v);

    const double n_by_r = motor.gear_ratio / robot.wheel_radius_m;
    const WheelVector shaft_radps = n_by_r * (model.drive().transpose() * q);
    const WheelVector shaft_radps2 = n_by_r * (model.drive().transpose() * q_dot);
    const WheelVector current_a =
        (voltages_v - motor.back_emf_v_s_per_rad * shaft_radps) / motor.resistance_ohm;
    const WheelVector force_n = n_by_r * (motor.torque_constant_nm_per_a * current_a -
                                          motor.rotor_inertia_kg_m2 * shaft_radps2 -
                                          motor.friction_nm_s_per_rad * shaft_radps);
    const Eigen::Vector3d load = model.drive() * force_n;
    EXPECT_NEAR(robot.mass_kg * (q_dot.x() - q.z() * q.y()), load.x(), 1e-12);
    EXPECT_NEAR(robot.mass_kg * (q_dot.y() + q.z() * q.x()), load.y(), 1e-12);
    EXPECT_NEAR(robot.inertia_kg_m2 * q_dot.z(), load.z(), 1e-12);
  }
}

TEST(RobotModel, AgreesWithEachMotorsEquation) { expect_body_and_motors_agree(omni3()); }
TEST(RobotModel, AgreesWithEachMotorsEquationOnFourWheels) {
  expect_body_and_motors_agree(RobotModel(four_wheels()));
}

TEST(RobotModel, VoltagesInvertTheDynamics) {
  for (const RobotModel& model : {omni3(), RobotModel(four_wheels())}) {
    const Eigen::Vector3d q(0.3, -0.4, 2.0);
    const Eigen::Vector3d q_dot(1.0, 0.5, -6.0);
    EXPECT_LT((model.acceleration(q, model.voltages_v(q, q_dot)) - q_dot).norm(), 1e-12);
  }
}

TEST(RobotModel, LinearizationIsTheDerivative) {
  const Eigen::Vector3d q(0.5, -0.3, 3.0);
  const WheelVector voltages_v = Eigen::Vector3d(1.0, -2.0, 3.0);
  const double h = 1e-4;  // the dynamics are quadratic: central differences have no error of method
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(i);
    const Eigen::Vector3d numeric =
        (omni3().acceleration(q + step, voltages_v) - omni3().acceleration(q - step, voltages_v)) /
        (2.0 * h);
    EXPECT_LT((omni3().linearization_per_s(q).col(i) - numeric).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(RobotModel, RefusesRobotsThatCannotDriveEverywhere) {
  RobotParameters two = RobotParameters{};
  two.wheels.pop_back();
  EXPECT_THROW(RobotModel{two}, std::invalid_argument);
  RobotParameters bundled = RobotParameters{};
  for (WheelMount& wheel : bundled.wheels) wheel.angle_rad = 1.0;
  EXPECT_THROW(RobotModel{bundled}, std::invalid_argument);
  RobotParameters weightless = RobotParameters{};
  weightless.mass_kg = 0.0;
  EXPECT_THROW(RobotModel{weightless}, std::invalid_argument);
}

}  // namespace
}  // namespace nadir::control_client
