#pragma once

#include <Eigen/Dense>
#include <cmath>

namespace nadir::fusion::test {

/// The extended Kalman filter of a planar pose as textbooks print it, with matrices of dynamic
/// size: independent of the project's, to compare results and speed with. State x, y, heading;
/// input u, v, r with covariance Q of the mean over dt.
class TextbookFilter {
 public:
  TextbookFilter(Eigen::VectorXd x, Eigen::MatrixXd p) : x_(std::move(x)), p_(std::move(p)) {}

  void predict(const Eigen::VectorXd& q, const Eigen::MatrixXd& q_covariance, double dt) {
    const double heading = x_[2] + 0.5 * dt * q[2];
    const double c = std::cos(heading);
    const double s = std::sin(heading);
    Eigen::MatrixXd rotation(3, 3);
    rotation << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
    Eigen::MatrixXd a = Eigen::MatrixXd::Identity(3, 3);
    a(0, 2) = dt * (-s * q[0] - c * q[1]);
    a(1, 2) = dt * (c * q[0] - s * q[1]);
    Eigen::MatrixXd w = dt * rotation;
    x_ = x_ + w * q;
    w(0, 2) = 0.5 * dt * a(0, 2);  // the yaw rate turns the heading half way
    w(1, 2) = 0.5 * dt * a(1, 2);
    x_[2] = std::remainder(x_[2], 2.0 * 3.14159265358979323846);
    p_ = a * p_ * a.transpose() + w * q_covariance * w.transpose();
  }

  void correct(const Eigen::VectorXd& z, const Eigen::MatrixXd& r) {
    const Eigen::MatrixXd h = Eigen::MatrixXd::Identity(3, 3);
    Eigen::VectorXd e = z - h * x_;
    e[2] = std::remainder(e[2], 2.0 * 3.14159265358979323846);
    const Eigen::MatrixXd s = h * p_ * h.transpose() + r;
    if (e.dot(s.inverse() * e) > 14.156) return;
    const Eigen::MatrixXd k = p_ * h.transpose() * s.inverse();
    const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(3, 3) - k * h;
    x_ = x_ + k * e;
    x_[2] = std::remainder(x_[2], 2.0 * 3.14159265358979323846);
    p_ = left * p_ * left.transpose() + k * r * k.transpose();
  }

  const Eigen::VectorXd& x() const { return x_; }
  const Eigen::MatrixXd& p() const { return p_; }

 private:
  Eigen::VectorXd x_;
  Eigen::MatrixXd p_;
};

}  // namespace nadir::fusion::test
