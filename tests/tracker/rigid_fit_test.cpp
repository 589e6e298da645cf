#include "tracker/rigid_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace nadir::tracker {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Matrix2d covariance(double xx, double xy, double yy) {
  return (Matrix2d() << xx, xy, xy, yy).finished();
}

// Markers seen exactly where a robot at `pose` carries them.
std::vector<PlaneMarker> exact_markers(const fusion::PlanarPose& pose,
                                       const std::vector<Vector2d>& mounted_m,
                                       const std::vector<Matrix2d>& covariances_m2) {
  const double c = std::cos(pose.heading_rad);
  const double s = std::sin(pose.heading_rad);
  std::vector<PlaneMarker> markers;
  for (std::size_t i = 0; i < mounted_m.size(); ++i) {
    const Vector2d& m = mounted_m[i];
    const Vector2d seen(pose.x_m + c * m.x() - s * m.y(), pose.y_m + s * m.x() + c * m.y());
    markers.push_back({seen, m, covariances_m2[i]});
  }
  return markers;
}

class Noise {
 public:
  explicit Noise(unsigned seed) : random_(seed) {}
  Vector2d draw(const Matrix2d& covariance_m2) {
    const double a = normal_(random_);
    const double b = normal_(random_);
    return covariance_m2.llt().matrixL() * Vector2d(a, b);
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

// The closed form for two markers that takes the position from the centre marker alone and the
// heading from the line between them; also the distance of the two, as a fourth value.
struct TwoMarkerCovariance {
  Matrix3d pose;                // x, y, heading
  Vector3d pose_with_distance;  // cov((x, y, heading), distance)
  double distance = 0.0;        // var(distance)
};

TwoMarkerCovariance two_marker_covariance(const Vector2d& d, const Matrix2d& c1,
                                          const Matrix2d& c2) {
  const Vector2d h = Vector2d(-d.y(), d.x()) / d.squaredNorm();
  const Vector2d along = d.normalized();
  TwoMarkerCovariance result;
  result.pose.topLeftCorner<2, 2>() = c1;
  result.pose(2, 2) = h.dot((c1 + c2) * h);
  result.pose.topRightCorner<2, 1>() = -c1 * h;
  result.pose.bottomLeftCorner<1, 2>() = (-c1 * h).transpose();
  result.pose_with_distance << -c1 * along, h.dot((c1 + c2) * along);
  result.distance = along.dot((c1 + c2) * along);
  return result;
}

const std::vector<Vector2d> kLeague = {
    {0.0, 0.0}, {0.035, 0.054772}, {-0.054772, 0.035}, {-0.054772, -0.035}, {0.035, -0.054772}};

std::vector<Matrix2d> uneven_covariances() {
  return {covariance(4e-7, 1e-7, 3e-7), covariance(9e-7, -2e-7, 8e-7), covariance(6e-7, 0.0, 2e-7),
          covariance(1e-6, 3e-7, 5e-7), covariance(3e-7, 1e-8, 9e-7)};
}

TEST(RigidFit, FindsTheExactPose) {
  for (const double heading_rad : {0.0, 1.0, 3.1, -3.1, -0.4, 3.14159265358979}) {
    const fusion::PlanarPose pose{1.2, -0.7, heading_rad};
    const RigidFit fit = fit_rigid_pose(exact_markers(pose, kLeague, uneven_covariances()));
    EXPECT_NEAR(fusion::pose_difference(fit.pose_world_robot, pose).norm(), 0.0, 1e-12);
    EXPECT_NEAR(fit.chi_square, 0.0, 1e-12);
    EXPECT_EQ(fit.degrees_of_freedom, 7);
  }
}

// The known distance is one more measurement, without error. Least squares uses it and the closed
// form does not, so the one covariance is the other conditioned on the distance: P - p p^T /
// var(distance).
TEST(RigidFit, OfTwoMarkersIsTheClosedFormConditionedOnTheirDistance) {
  const fusion::PlanarPose pose{0.3, 0.1, 0.8};
  const Matrix2d c1 = covariance(4e-7, 1e-7, 3e-7);
  const Matrix2d c2 = covariance(9e-7, -2e-7, 6e-7);
  const auto markers = exact_markers(pose, {{0.0, 0.0}, {0.06, 0.0}}, {c1, c2});
  const RigidFit fit = fit_rigid_pose(markers);

  const Vector2d d = markers[1].position_world_m - markers[0].position_world_m;
  const TwoMarkerCovariance closed = two_marker_covariance(d, c1, c2);
  const Matrix3d conditioned = closed.pose - closed.pose_with_distance *
                                                 closed.pose_with_distance.transpose() /
                                                 closed.distance;
  EXPECT_LT((fit.covariance - conditioned).norm(), 1e-9 * conditioned.norm());
  EXPECT_LT(fit.covariance(0, 0), closed.pose(0, 0));
}

// Equal round errors do not tie heading and distance together: then both agree in the heading, and
// across the line.
TEST(RigidFit, OfTwoEqualMarkersHasTheHeadingOfTheClosedForm) {
  const Matrix2d round = covariance(5e-7, 0.0, 5e-7);
  const auto markers = exact_markers({0.0, 0.0, 0.0}, {{0.0, 0.0}, {0.06, 0.0}}, {round, round});
  const RigidFit fit = fit_rigid_pose(markers);
  const TwoMarkerCovariance closed = two_marker_covariance({0.06, 0.0}, round, round);
  EXPECT_NEAR(fit.covariance(2, 2), closed.pose(2, 2), 1e-9 * closed.pose(2, 2));
  EXPECT_NEAR(fit.covariance(1, 2), closed.pose(1, 2), 1e-9 * std::abs(closed.pose(1, 2)));
  EXPECT_NEAR(fit.covariance(1, 1), closed.pose(1, 1), 1e-9 * closed.pose(1, 1));
  EXPECT_NEAR(fit.covariance(0, 0), closed.pose(0, 0) / 2.0, 1e-9 * closed.pose(0, 0));
}

struct MonteCarlo {
  Matrix3d sampled = Matrix3d::Zero();
  double nees = 0.0;
  double chi_square = 0.0;
  double inflated_nees = 0.0;  // NEES with the covariance times max(1, chi^2 / dof)
};

MonteCarlo run_monte_carlo(const std::vector<Vector2d>& mounted_m,
                           const std::vector<Matrix2d>& covariances_m2, int samples) {
  const fusion::PlanarPose truth{0.9, -1.4, 2.9};
  const auto exact = exact_markers(truth, mounted_m, covariances_m2);
  Noise noise(20240917);
  MonteCarlo sum;
  for (int k = 0; k < samples; ++k) {
    auto markers = exact;
    for (PlaneMarker& marker : markers) marker.position_world_m += noise.draw(marker.covariance_m2);
    const RigidFit fit = fit_rigid_pose(markers);
    const Vector3d error = fusion::pose_difference(fit.pose_world_robot, truth);
    const double nees = error.dot(fit.covariance.inverse() * error);
    sum.sampled += error * error.transpose() / samples;
    sum.nees += nees / samples;
    sum.chi_square += fit.chi_square / samples;
    sum.inflated_nees += nees / std::max(1.0, fit.chi_square / fit.degrees_of_freedom) / samples;
  }
  return sum;
}

void expect_within_two_percent(const Matrix3d& sampled, const Matrix3d& predicted) {
  const Vector3d sigma = predicted.diagonal().cwiseSqrt();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(sampled(i, j), predicted(i, j), 0.02 * sigma(i) * sigma(j)) << i << ", " << j;
    }
  }
}

constexpr int kSamples = 200000;
// 99.9 % bands of a mean over kSamples: chi-square with k degrees of freedom has variance 2 k.
double band(int degrees_of_freedom) {
  return 3.29 * std::sqrt(2.0 * degrees_of_freedom / kSamples);
}

TEST(RigidFit, PredictsTheScatterOfFiveMarkers) {
  const MonteCarlo run = run_monte_carlo(kLeague, uneven_covariances(), kSamples);
  const auto exact = exact_markers({0.9, -1.4, 2.9}, kLeague, uneven_covariances());
  expect_within_two_percent(run.sampled, fit_rigid_pose(exact).covariance);
  EXPECT_NEAR(run.nees, 3.0, band(3));
  EXPECT_NEAR(run.chi_square, 7.0, band(7));
}

TEST(RigidFit, PredictsTheScatterOfTwoMarkers) {
  const std::vector<Vector2d> pair = {{0.0, 0.0}, {0.06, 0.0}};
  const std::vector<Matrix2d> covariances = {covariance(4e-7, 1e-7, 3e-7),
                                             covariance(9e-7, -2e-7, 6e-7)};
  const MonteCarlo run = run_monte_carlo(pair, covariances, kSamples);
  expect_within_two_percent(
      run.sampled, fit_rigid_pose(exact_markers({0.9, -1.4, 2.9}, pair, covariances)).covariance);
  EXPECT_NEAR(run.nees, 3.0, band(3));
  EXPECT_NEAR(run.chi_square, 1.0, band(1));
  // What Birge's ratio costs where nothing is wrong: residual and pose are independent, so the mean
  // is 3 E[1 / max(1, z^2)] = 3 (erf(1/sqrt 2) + 2 phi(1) - erfc(1/sqrt 2)), a cautious 2.55.
  const double phi = std::exp(-0.5) / std::sqrt(2.0 * M_PI);
  const double expected = 3.0 * (std::erf(std::sqrt(0.5)) + 2.0 * phi - std::erfc(std::sqrt(0.5)));
  EXPECT_NEAR(expected, 2.55, 0.01);
  EXPECT_NEAR(run.inflated_nees, expected, band(3));
}

TEST(RigidFit, WeighsGoodMarkersMore) {
  auto covariances = uneven_covariances();
  covariances[3] *= 1e6;
  auto markers = exact_markers({0.0, 0.0, 0.5}, kLeague, covariances);
  markers[3].position_world_m.x() += 0.02;
  const RigidFit fit = fit_rigid_pose(markers);
  EXPECT_NEAR(fit.pose_world_robot.x_m, 0.0, 1e-6);
  EXPECT_NEAR(fit.pose_world_robot.heading_rad, 0.5, 1e-5);
}

}  // namespace
}  // namespace nadir::tracker
