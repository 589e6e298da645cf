#include "tracker/tag_pose.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "tracker/pixel_near.h"

namespace nadir::tracker {
namespace {

constexpr int kGaussNewtonSteps = 3;

Eigen::Vector2d turned(const Eigen::Vector2d& v, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// The robot that has this tag there.
fusion::PlanarPose robot_of(const TagPose& tag) {
  const double heading_rad =
      fusion::wrap_angle(tag.pose_world_tag.heading_rad - tag.mount.heading_robot_rad);
  const Eigen::Vector2d place_m =
      tag.pose_world_tag.position_m() - turned(tag.mount.position_robot_m, heading_rad);
  return {place_m.x(), place_m.y(), heading_rad};
}

// libapriltag's lines are off by up to an eighth of a pixel where an edge keeps its distance from
// the pixels' middles all along: where it lies along rows or columns. All four edges share that.
double lattice_deviation_px(const vision::TagObservation& tag, double side_px) {
  constexpr double kAlong_px = 0.09;
  const Eigen::Vector2d right_px =
      (tag.corners_px[1] - tag.corners_px[0] + tag.corners_px[2] - tag.corners_px[3]).cwiseAbs();
  const double slope = right_px.minCoeff() / std::max(right_px.maxCoeff(), 1e-9);
  return kAlong_px / std::max(1.0, side_px * slope);
}

// Of the residuals (place, heading) of a tag, derivative -a by the robot's pose.
struct Linear {
  Eigen::Vector3d residual;
  Eigen::Matrix3d a = Eigen::Matrix3d::Identity();
};

Linear linear(const TagPose& tag, const fusion::PlanarPose& robot) {
  Linear result;
  const Eigen::Vector2d arm = turned(tag.mount.position_robot_m, robot.heading_rad);
  result.residual.head<2>() = tag.pose_world_tag.position_m() - robot.position_m() - arm;
  result.residual.z() = fusion::wrap_angle(tag.pose_world_tag.heading_rad - robot.heading_rad -
                                           tag.mount.heading_robot_rad);
  result.a(0, 2) = -arm.y();
  result.a(1, 2) = arm.x();
  return result;
}

}  // namespace

TagDeviation tag_deviation(double side_px, double contrast) {
  constexpr double kFloor_px = 0.011;
  constexpr double kHeadingFloor_px = 0.0205;
  constexpr double kSmall_px3 = 12.5;
  constexpr double kNoise = 0.6;   // grey levels times pixels
  constexpr double kLever = 1.45;  // the heading's error times the side over the middle's error
  const double size = std::max(side_px, 10.0);
  const double noise_px = kNoise / std::max(contrast, 5.0);
  const double small_px = std::hypot(kSmall_px3 / (size * size), noise_px);
  return {std::hypot(kFloor_px, small_px), kLever * std::hypot(kHeadingFloor_px, small_px) / size};
}

TagPose tag_pose(const vision::TagObservation& tag, double size_m, const vision::TagMount& mount,
                 const calibration::PlaneMap& map) {
  std::array<Eigen::Vector2d, 4> corners_m;
  Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    corners_m[i] = map.plane_from_pixel(tag.corners_px[i]);
    middle_m += 0.25 * corners_m[i];
  }
  const Eigen::Vector2d right_m = corners_m[1] - corners_m[0] + corners_m[2] - corners_m[3];
  const Eigen::Vector2d up_m = corners_m[3] - corners_m[0] + corners_m[2] - corners_m[1];
  // Up is a quarter turn to the left of right, or to the right where the plane's axes are mirrored.
  const double left = cross(right_m, up_m) > 0.0 ? 1.0 : -1.0;
  const Eigen::Vector2d axis_m = right_m + left * Eigen::Vector2d(up_m.y(), -up_m.x());

  TagPose pose;
  pose.mount = mount;
  pose.centre_px =
      0.25 * (tag.corners_px[0] + tag.corners_px[1] + tag.corners_px[2] + tag.corners_px[3]);
  pose.pose_world_tag = {middle_m.x(), middle_m.y(), std::atan2(axis_m.y(), axis_m.x())};
  const Eigen::Vector2d x_m = 0.5 * size_m * axis_m.normalized();
  const Eigen::Vector2d y_m = left * Eigen::Vector2d(-x_m.y(), x_m.x());
  const std::array<Eigen::Vector2d, 4> square_m = {-x_m - y_m, x_m - y_m, x_m + y_m, -x_m + y_m};
  for (std::size_t i = 0; i < 4; ++i) {
    const double off_m = (corners_m[i] - middle_m - square_m[i]).norm();
    pose.misshape = std::max(pose.misshape, off_m / size_m);
  }
  const double side_px = std::sqrt(vision::area_px2(tag));
  const TagDeviation deviation = tag_deviation(side_px, 2.0 * tag.decision_margin);
  const double centre_px = std::hypot(deviation.centre_px, lattice_deviation_px(tag, side_px));
  const Eigen::Matrix2d jacobian = map.jacobian_m_per_px(pose.centre_px);
  pose.covariance.topLeftCorner<2, 2>() = centre_px * centre_px * jacobian * jacobian.transpose();
  pose.covariance(2, 2) = deviation.heading_rad * deviation.heading_rad;
  return pose;
}

MarkerPose pose_from_tags(std::span<const TagPose> tags, const calibration::PlaneMap& map) {
  assert(!tags.empty());
  MarkerPose result;
  fusion::PlanarPose robot = robot_of(tags.front());
  Eigen::Matrix3d information;
  double chi_square = 0.0;
  for (int step = 0; step <= kGaussNewtonSteps; ++step) {
    information.setZero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    chi_square = 0.0;
    for (const TagPose& tag : tags) {
      const Linear at = linear(tag, robot);
      const Eigen::Matrix3d weight = tag.covariance.inverse();
      information += at.a.transpose() * weight * at.a;
      gradient += at.a.transpose() * weight * at.residual;
      chi_square += at.residual.dot(weight * at.residual);
    }
    if (step == kGaussNewtonSteps) break;
    const Eigen::Vector3d change = information.inverse() * gradient;
    robot.x_m += change.x();
    robot.y_m += change.y();
    robot.heading_rad = fusion::wrap_angle(robot.heading_rad + change.z());
  }
  const double freedoms = 3.0 * static_cast<double>(tags.size()) - 3.0;
  result.chi_square_per_dof = freedoms > 0.0 ? chi_square / freedoms : 0.0;
  result.pose_world_robot = robot;
  result.covariance = information.inverse() * std::max(1.0, result.chi_square_per_dof);
  result.centre_px = pixel_near(map, robot.position_m(), tags.front().centre_px);
  result.covariance.topLeftCorner<2, 2>() += map.calibration_covariance_m2(result.centre_px);
  return result;
}

}  // namespace nadir::tracker
