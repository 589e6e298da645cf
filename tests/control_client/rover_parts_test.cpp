#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>

#include "control_client/rover/potential_field.h"
#include "control_client/rover/rover_model.h"
#include "control_client/rover/rover_plant.h"
#include "control_client/rover/velocity_controller.h"
#include "control_client/rover/velocity_source.h"

namespace nadir::control_client {
namespace {

TEST(RoverModel, HasTheDeterminantAndTheInverseOfTheory) {
  const RoverModel model;
  for (const double heading_rad : {-2.0, 0.0, 0.4, 3.1}) {
    const Eigen::Matrix3d b = model.wheel_matrix(heading_rad);
    EXPECT_NEAR(b.determinant(), 1.5 * std::sqrt(3.0) * 0.10, 1e-12);
    const Eigen::Vector3d force(1.0, -2.0, 0.3);
    EXPECT_LT((b * model.wheel_forces(heading_rad, force) - force).norm(), 1e-12);
  }
}

TEST(RoverPlant, StandsWhileTheDriveIsSmallerThanFriction) {
  RoverPlant plant(RoverModel{}, {});
  plant.start({1.0, 2.0, 0.3});
  plant.drive({0.0, 0.3, -0.3}, 5.0);
  EXPECT_LT((plant.pose().position_m() - Eigen::Vector2d(1.0, 2.0)).norm(), 5.0 * 0.002);
  EXPECT_LT(plant.velocity().head<2>().norm(), 0.003);
}

TEST(RoverPlant, AcceleratesByWhatIsLeftOfTheDrive) {
  // Along body x wheels 2 and 3 push and rub, wheel 1 stands across: M a = sqrt3/2 * 2 F' with
  // F' = 0.95 u - 0.35 N at heading 90 degrees in the geometry of theory 6.
  RoverPlant plant(RoverModel{}, {});
  plant.start({0.0, 0.0, 0.0});
  plant.drive({0.0, -2.0, 2.0}, 1.0);
  const double force_n = std::sqrt(3.0) * (0.95 * 2.0 - 0.35);
  EXPECT_NEAR(plant.velocity().y(), force_n / 1.5, 2e-3);
  EXPECT_NEAR(plant.pose().y_m, 0.5 * force_n / 1.5, 2e-3);
  EXPECT_NEAR(plant.velocity().x(), 0.0, 1e-9);
  EXPECT_NEAR(plant.heading_rad(), 0.0, 1e-9);
  plant.drive(Eigen::Vector3d::Zero(), 10.0);
  EXPECT_NEAR(plant.velocity().norm(), 0.0, 1e-6);
}

TEST(PotentialField, VelocitiesAreTheSlopesOfThePotentials) {
  const PotentialField field;
  const Eigen::Vector2d there(2.0, -1.0);
  const auto attracting = [&](const Eigen::Vector2d& p) {
    return field.speed_mps * std::sqrt((p - there).squaredNorm() + 0.25);
  };
  const auto repelling = [&](const Eigen::Vector2d& p) {
    return field.repulsion_m2ps * std::exp(-(p - there).norm() / field.repulsion_length_m);
  };
  const auto slope = [](const std::function<double(const Eigen::Vector2d&)>& u,
                        const Eigen::Vector2d& p) -> Eigen::Vector2d {
    constexpr double kStep = 1e-5;
    const Eigen::Vector2d x(kStep, 0.0);
    const Eigen::Vector2d y(0.0, kStep);
    return Eigen::Vector2d(u(p + x) - u(p - x), u(p + y) - u(p - y)) / (2.0 * kStep);
  };
  for (const Eigen::Vector2d& p :
       {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(2.2, -0.9), Eigen::Vector2d(5.0, 3.0)}) {
    EXPECT_LT((field.attraction_mps(p, there) + slope(attracting, p)).norm(), 1e-8);
    EXPECT_LT((field.repulsion_mps(p, there) + slope(repelling, p)).norm(), 1e-8);
    EXPECT_LT(field.attraction_mps(p, there).norm(), field.speed_mps);
  }
  EXPECT_EQ(field.repulsion_mps(there, there).norm(), 0.0);
}

TEST(WaypointTour, GoesOnWhenAPointIsReachedAndKeepsTheLast) {
  WaypointTour tour({{1.0, 0.0}, {2.0, 0.0}}, 0.2);
  EXPECT_EQ(tour.next({0.0, 0.0}).x(), 1.0);
  EXPECT_EQ(tour.next({0.9, 0.0}).x(), 2.0);
  EXPECT_EQ(tour.next({0.0, 0.0}).x(), 2.0);
  EXPECT_FALSE(tour.is_done());
  EXPECT_EQ(tour.next({2.1, 0.1}).x(), 2.0);
  EXPECT_TRUE(tour.is_done());
  EXPECT_EQ(tour.next({0.0, 0.0}).x(), 2.0);
}

TEST(VelocityController, IsAPidWithAScaleForEachAxis) {
  VelocityGains gains;
  gains.axis_scale = {1.0, 0.5, 0.03};
  VelocityController controller(gains, 0.1);
  const Eigen::Vector3d error(0.2, 0.2, 0.2);
  const Eigen::Vector3d acceleration(1.0, 1.0, 1.0);
  controller.force(error, Eigen::Vector3d::Zero(), acceleration);
  const Eigen::Vector3d force = controller.force(error, Eigen::Vector3d::Zero(), acceleration);
  const double pid = 8.0 * 0.2 + 7.0 * (2 * 0.1 * 0.2) + 0.2 * 1.0;
  EXPECT_LT((force - pid * gains.axis_scale).norm(), 1e-12);
}

TEST(VelocitySource, OfDifferencesFollowsAConstantVelocityAcrossTheWrap) {
  VelocitySettings settings;
  settings.kind = VelocityKind::kDifferences;
  settings.observer.fill(fusion::gains_of_bandwidth(5.0, 1.0));
  VelocitySource source(settings, {1.5, 1.5, 0.025}, 0.05);
  source.start({0.0, 0.0, 3.0});
  const Eigen::Vector3d velocity(0.3, -0.2, 0.5);
  for (int k = 1; k <= 100; ++k) {
    source.predict(Eigen::Vector3d::Zero());
    const Eigen::Vector3d way = 0.05 * k * velocity;
    source.correct({way.x(), way.y(), fusion::wrap_angle(3.0 + way.z())});
  }
  EXPECT_LT((source.velocity() - velocity).norm(), 1e-9);
  EXPECT_LT(source.acceleration().norm(), 1e-8);
  EXPECT_EQ(source.disturbance().norm(), 0.0);
}

}  // namespace
}  // namespace nadir::control_client
