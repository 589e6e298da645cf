#include "tracker/rigid_fit.h"

#include <Eigen/LU>
#include <cassert>
#include <cmath>

namespace nadir::tracker {
namespace {

// The closed form starts within the noise; the last step of three changes nothing that a double can
// show.
constexpr int kGaussNewtonSteps = 3;

Eigen::Matrix2d rotation(double heading_rad) {
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  return (Eigen::Matrix2d() << c, -s, s, c).finished();
}

fusion::PlanarPose procrustes(std::span<const PlaneMarker> markers) {
  Eigen::Vector2d mean_world = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_robot = Eigen::Vector2d::Zero();
  for (const PlaneMarker& marker : markers) {
    mean_world += marker.position_world_m / static_cast<double>(markers.size());
    mean_robot += marker.position_robot_m / static_cast<double>(markers.size());
  }
  double dot = 0.0;
  double cross = 0.0;
  for (const PlaneMarker& marker : markers) {
    const Eigen::Vector2d a = marker.position_robot_m - mean_robot;
    const Eigen::Vector2d b = marker.position_world_m - mean_world;
    dot += a.dot(b);
    cross += a.x() * b.y() - a.y() * b.x();
  }
  const double heading_rad = std::atan2(cross, dot);
  const Eigen::Vector2d position = mean_world - rotation(heading_rad) * mean_robot;
  return {position.x(), position.y(), heading_rad};
}

// A^T W A, A^T W r and r^T W r of the residuals r_i = seen_i - (t + R(heading) mounted_i),
// whose derivative by (x, y, heading) is -A_i = -[I, R'(heading) mounted_i]; W_i = C_i^-1.
struct NormalEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double chi_square = 0.0;
};

NormalEquations normal_equations(std::span<const PlaneMarker> markers,
                                 const fusion::PlanarPose& pose) {
  NormalEquations sum;
  const Eigen::Matrix2d turn = rotation(pose.heading_rad);
  for (const PlaneMarker& marker : markers) {
    const Eigen::Vector2d lever = turn * marker.position_robot_m;
    const Eigen::Vector2d residual = marker.position_world_m - pose.position_m() - lever;
    Eigen::Matrix<double, 2, 3> a;
    a << 1.0, 0.0, -lever.y(), 0.0, 1.0, lever.x();
    const Eigen::Matrix2d weight = marker.covariance_m2.inverse();
    sum.information += a.transpose() * weight * a;
    sum.gradient += a.transpose() * weight * residual;
    sum.chi_square += residual.dot(weight * residual);
  }
  return sum;
}

}  // namespace

RigidFit fit_rigid_pose(std::span<const PlaneMarker> markers) {
  assert(markers.size() >= 2);
  RigidFit fit;
  fit.pose_world_robot = procrustes(markers);
  for (int step = 0; step < kGaussNewtonSteps; ++step) {
    const NormalEquations normal = normal_equations(markers, fit.pose_world_robot);
    const Eigen::Vector3d change = normal.information.inverse() * normal.gradient;
    fit.pose_world_robot.x_m += change.x();
    fit.pose_world_robot.y_m += change.y();
    fit.pose_world_robot.heading_rad =
        fusion::wrap_angle(fit.pose_world_robot.heading_rad + change.z());
  }
  const NormalEquations normal = normal_equations(markers, fit.pose_world_robot);
  fit.covariance = normal.information.inverse();
  fit.chi_square = normal.chi_square;
  fit.degrees_of_freedom = 2 * static_cast<int>(markers.size()) - 3;
  return fit;
}

}  // namespace nadir::tracker
