#include "tracker/pose_from_markers.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

namespace nadir::tracker {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// A slightly curved map of a 640x480 image, about 5 mm per px. `mirrored`: v down and y up, as
// every camera sees it that looks down on a field with a right-handed frame; otherwise y goes down
// too.
calibration::PlaneMap curved_map(bool mirrored, double noise_variance_m2 = 0.0,
                                 double lack_of_fit_m2 = 0.0) {
  calibration::PolynomialMap::Parameters parameters;
  parameters.order = 2;
  parameters.centre_px = {320.0, 240.0};
  parameters.scale_px = 320.0;
  const double sign = mirrored ? -1.0 : 1.0;
  parameters.coefficients_m.resize(2, 6);
  parameters.coefficients_m << 0.1, 1.6, 0.02, 0.03, 0.01, -0.02,  //
      -0.2, 0.03, sign * 1.62, 0.01, 0.02, 0.025;
  parameters.information_inverse = Eigen::MatrixXd::Identity(6, 6) / 24.0;
  parameters.noise_variance_m2 = noise_variance_m2;
  return calibration::PlaneMap(calibration::PolynomialMap(parameters),
                               {calibration::LackOfFit::uniform(lack_of_fit_m2), {}});
}

vision::MarkerLayout league_layout() {
  vision::MarkerLayout layout;
  layout.centre_radius_m = 0.025;
  layout.teams = {{"blue", vision::Colour::kBlue}};
  for (const Vector2d& place : {Vector2d(0.035, 0.054772), Vector2d(-0.054772, 0.035),
                                Vector2d(-0.054772, -0.035), Vector2d(0.035, -0.054772)}) {
    layout.outer.push_back({place, 0.02, vision::Colour::kPink});
  }
  return layout;
}

vision::MarkerLayout pair_layout() {
  vision::MarkerLayout layout = league_layout();
  layout.outer = {{{0.06, 0.0}, 0.025, vision::Colour::kYellow}};
  return layout;
}

// What an ideal detector sees of a robot.
vision::RobotObservation seen_at(const fusion::PlanarPose& pose, const vision::MarkerLayout& layout,
                                 const calibration::PlaneMap& map) {
  vision::RobotObservation robot;
  robot.disc_count = layout.disc_count();
  const double c = std::cos(pose.heading_rad);
  const double s = std::sin(pose.heading_rad);
  for (int i = 0; i < robot.disc_count; ++i) {
    const Vector2d place =
        i == 0 ? Vector2d::Zero() : layout.outer[static_cast<std::size_t>(i - 1)].position_robot_m;
    const Vector2d world =
        pose.position_m() + Vector2d(c * place.x() - s * place.y(), s * place.x() + c * place.y());
    robot.discs[static_cast<std::size_t>(i)].centre_px = map.pixel_from_plane(world).value();
  }
  return robot;
}

// Every disc's centre with the same covariance in the image, brought to the plane.
DiscCovariances same_for_all(const Matrix2d& covariance_px2, const vision::RobotObservation& robot,
                             const calibration::PlaneMap& map) {
  DiscCovariances all;
  for (std::size_t i = 0; i < static_cast<std::size_t>(robot.disc_count); ++i) {
    const Matrix2d jacobian = map.jacobian_m_per_px(robot.discs[i].centre_px);
    all[i] = jacobian * covariance_px2 * jacobian.transpose();
  }
  return all;
}

class PoseFromMarkers : public testing::TestWithParam<bool> {};

TEST_P(PoseFromMarkers, FindsPoseAndPixelOfAnIdealSight) {
  const calibration::PlaneMap map = curved_map(GetParam());
  for (const vision::MarkerLayout& layout : {league_layout(), pair_layout()}) {
    for (const fusion::PlanarPose& pose : {fusion::PlanarPose{0.1, -0.2, 0.0},
                                           {-1.2, 0.7, 2.5},
                                           {1.1, -0.9, -3.0},
                                           {0.4, 0.6, 1.57}}) {
      const vision::RobotObservation robot = seen_at(pose, layout, map);
      const MarkerPose found = pose_from_markers(
          robot, layout, map, same_for_all(Matrix2d::Identity() * 1e-3, robot, map));
      EXPECT_LT(fusion::pose_difference(found.pose_world_robot, pose).norm(), 1e-8);
      EXPECT_LT((found.centre_px - map.pixel_from_plane(pose.position_m()).value()).norm(), 1e-6);
      EXPECT_LT(found.chi_square_per_dof, 1e-6);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(MirroredOrNot, PoseFromMarkers, testing::Bool(), [](const auto& test) {
  return test.param ? "ImageDownWorldUp" : "BothDown";
});

// From noise in pixels, the same and not round for all discs, to the covariance of the pose.
TEST(PoseFromMarkersCovariance, MatchesTwoHundredThousandSamples) {
  constexpr int kSamples = 200000;
  const calibration::PlaneMap map = curved_map(true);
  const vision::MarkerLayout layout = league_layout();
  const fusion::PlanarPose truth{0.7, 0.5, -2.2};
  const vision::RobotObservation exact = seen_at(truth, layout, map);
  const double sigma_u_px = 0.08;
  const double sigma_v_px = 0.05;
  const DiscCovariances covariances = same_for_all(
      Vector2d(sigma_u_px * sigma_u_px, sigma_v_px * sigma_v_px).asDiagonal(), exact, map);
  const Matrix3d predicted = pose_from_markers(exact, layout, map, covariances).covariance;

  std::mt19937 random(4711);
  std::normal_distribution<double> normal;
  Matrix3d sampled = Matrix3d::Zero();
  double nees = 0.0;
  double chi_square_per_dof = 0.0;
  Vector2d pixel_variance = Vector2d::Zero();
  for (int k = 0; k < kSamples; ++k) {
    vision::RobotObservation robot = exact;
    for (int i = 0; i < robot.disc_count; ++i) {
      robot.discs[static_cast<std::size_t>(i)].centre_px +=
          Vector2d(sigma_u_px * normal(random), sigma_v_px * normal(random));
    }
    const MarkerPose found = pose_from_markers(robot, layout, map, covariances);
    const Vector3d error = fusion::pose_difference(found.pose_world_robot, truth);
    sampled += error * error.transpose() / kSamples;
    nees += error.dot(predicted.inverse() * error) / kSamples;
    chi_square_per_dof += found.chi_square_per_dof / kSamples;
    pixel_variance += (found.centre_px - exact.discs[0].centre_px).cwiseAbs2() / kSamples;
  }
  const Vector3d sigma = predicted.diagonal().cwiseSqrt();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(sampled(i, j), predicted(i, j), 0.02 * sigma(i) * sigma(j)) << i << ", " << j;
    }
  }
  // 99.9 % bands of the means of chi-squares with 3 and 7 degrees of freedom.
  EXPECT_NEAR(nees, 3.0, 3.29 * std::sqrt(2.0 * 3.0 / kSamples));
  EXPECT_NEAR(chi_square_per_dof, 1.0, 3.29 * std::sqrt(2.0 / 7.0 / kSamples));
  // The pixel of the robot profits from all five discs: a fifth of one disc's variance, and a
  // little more, as the league's centre disc is not quite the middle of the five.
  EXPECT_NEAR(pixel_variance.x() / (sigma_u_px * sigma_u_px), 0.2, 0.02);
  EXPECT_NEAR(pixel_variance.y() / (sigma_v_px * sigma_v_px), 0.2, 0.02);
}

TEST(PoseFromMarkersCovariance, CalibrationErrorIsCommonToAllDiscs) {
  const double calibration_variance_m2 = 4e-6;
  const calibration::PlaneMap perfect = curved_map(true);
  const calibration::PlaneMap rough = curved_map(true, 0.0, calibration_variance_m2);
  const vision::MarkerLayout layout = league_layout();
  const vision::RobotObservation robot = seen_at({0.2, 0.3, 0.4}, layout, perfect);
  const DiscCovariances covariances = same_for_all(Matrix2d::Identity() * 2.5e-3, robot, perfect);
  const Matrix3d added = pose_from_markers(robot, layout, rough, covariances).covariance -
                         pose_from_markers(robot, layout, perfect, covariances).covariance;
  Matrix3d expected = Matrix3d::Zero();
  expected(0, 0) = expected(1, 1) = calibration_variance_m2;
  EXPECT_LT((added - expected).norm(), 1e-12);
}

// A disc that is half covered: its centre is off by far more than its variance says.
TEST(PoseFromMarkersCovariance, GrowsWhereResidualsDoNotFit) {
  const calibration::PlaneMap map = curved_map(true);
  const vision::MarkerLayout layout = league_layout();
  vision::RobotObservation robot = seen_at({0.2, 0.3, 0.4}, layout, map);
  const DiscCovariances covariances = same_for_all(Matrix2d::Identity() * 1e-3, robot, map);
  const MarkerPose good = pose_from_markers(robot, layout, map, covariances);
  robot.discs[2].centre_px.x() += 0.5;
  const MarkerPose bad = pose_from_markers(robot, layout, map, covariances);
  EXPECT_GT(bad.chi_square_per_dof, 5.0);
  EXPECT_NEAR(bad.covariance.trace() / good.covariance.trace(), bad.chi_square_per_dof,
              0.01 * bad.chi_square_per_dof);
}

}  // namespace
}  // namespace nadir::tracker
