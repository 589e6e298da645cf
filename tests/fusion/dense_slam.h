#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "fusion/slam/range_bearing.h"

namespace nadir::fusion::test {

/// The textbook's filter with one dense matrix, as the independent implementation.
class DenseSlam {
 public:
  DenseSlam(const PlanarPose& pose, const PoseCovariance& covariance)
      : x_(Eigen::Vector3d(pose.x_m, pose.y_m, pose.heading_rad)), p_(covariance) {}

  void move(const Eigen::Vector3d& by, const Eigen::Matrix3d& q) {
    x_.head<3>() += by;
    p_.topLeftCorner<3, 3>() += q;
  }
  void observe(int landmark, const Eigen::Vector2d& z, const Eigen::Matrix2d& r) {
    const Eigen::Index n = x_.size();
    if (3 + 2 * landmark == n) {
      const auto placed = placed_landmark(pose(), {z[0], z[1]});
      Eigen::MatrixXd g = Eigen::MatrixXd::Zero(n + 2, n);
      g.topRows(n).setIdentity();
      g.block(n, 0, 2, 3) = placed.by_pose;
      Eigen::MatrixXd grown = g * p_ * g.transpose();
      grown.bottomRightCorner<2, 2>() += placed.by_sighting * r * placed.by_sighting.transpose();
      p_ = grown;
      x_.conservativeResize(n + 2);
      x_.tail<2>() = placed.place_m;
      return;
    }
    const auto predicted = predicted_sighting(pose(), x_.segment<2>(3 + 2 * landmark));
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(2, n);
    h.leftCols<3>() = predicted.by_pose;
    h.middleCols<2>(3 + 2 * landmark) = predicted.by_landmark;
    const Eigen::Matrix2d s = h * p_ * h.transpose() + r;
    const Eigen::MatrixXd k = p_ * h.transpose() * s.inverse();
    x_ += k * sighting_difference({z[0], z[1]}, predicted.seen);
    const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(n, n) - k * h;
    p_ = (left * p_ * left.transpose() + k * r * k.transpose()).eval();
  }
  const Eigen::VectorXd& x() const { return x_; }
  const Eigen::MatrixXd& p() const { return p_; }

 private:
  PlanarPose pose() const { return {x_[0], x_[1], x_[2]}; }

  Eigen::VectorXd x_;
  Eigen::MatrixXd p_;
};

}  // namespace nadir::fusion::test
