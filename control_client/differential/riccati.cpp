#include "control_client/differential/riccati.h"

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>
#include <unsupported/Eigen/MatrixFunctions>

namespace nadir::control_client {
namespace {

constexpr int kMostSteps = 100;
constexpr double kConverged = 1e-13;

[[noreturn]] void throw_unsolvable() {
  throw std::invalid_argument(
      "the Riccati equation has no stabilising solution: the system cannot be stabilised, or the "
      "weights do not see an unstable part of it");
}

}  // namespace

Eigen::MatrixXd solve_continuous_riccati(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                                         const Eigen::MatrixXd& q, const Eigen::MatrixXd& r) {
  const Eigen::Index n = a.rows();
  Eigen::MatrixXd sign(2 * n, 2 * n);
  sign << a, -b * r.inverse() * b.transpose(), -q, -a.transpose();
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::PartialPivLU<Eigen::MatrixXd> lu(sign);
    const double determinant = std::abs(lu.determinant());
    if (!(determinant > 0.0) || !std::isfinite(determinant)) throw_unsolvable();
    // Byers' scaling: eigenvalues are brought near the unit circle first.
    const double scale = std::pow(determinant, -1.0 / (2.0 * static_cast<double>(n)));
    const Eigen::MatrixXd next = 0.5 * (scale * sign + lu.inverse() / scale);
    const double change = (next - sign).norm();
    sign = next;
    if (!sign.allFinite()) throw_unsolvable();
    if (change > kConverged * sign.norm()) continue;
    // sign(H) [I; X] = -[I; X]
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n, n);
    Eigen::MatrixXd left(2 * n, n);
    Eigen::MatrixXd right(2 * n, n);
    left << sign.topRightCorner(n, n), sign.bottomRightCorner(n, n) + identity;
    right << sign.topLeftCorner(n, n) + identity, sign.bottomLeftCorner(n, n);
    const Eigen::MatrixXd x = -left.colPivHouseholderQr().solve(right);
    const Eigen::MatrixXd closed = a - b * r.inverse() * b.transpose() * x;
    if (!x.allFinite() || closed.eigenvalues().real().maxCoeff() >= 0.0) throw_unsolvable();
    return 0.5 * (x + x.transpose());
  }
  throw_unsolvable();
}

Eigen::MatrixXd solve_discrete_riccati(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                                       const Eigen::MatrixXd& q, const Eigen::MatrixXd& r) {
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(a.rows(), a.rows());
  Eigen::MatrixXd power = a;
  Eigen::MatrixXd g = b * r.inverse() * b.transpose();
  Eigen::MatrixXd x = q;
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::PartialPivLU<Eigen::MatrixXd> lu(identity + g * x);
    const Eigen::MatrixXd through = lu.solve(power);
    const Eigen::MatrixXd more = power.transpose() * x * through;
    g += power * lu.solve(g) * power.transpose();
    x += more;
    power = power * through;
    if (!x.allFinite()) throw_unsolvable();
    if (more.norm() > kConverged * x.norm()) continue;
    const Eigen::MatrixXd gain = (r + b.transpose() * x * b).inverse() * b.transpose() * x * a;
    if (Eigen::MatrixXd(a - b * gain).eigenvalues().cwiseAbs().maxCoeff() >= 1.0)
      throw_unsolvable();
    return 0.5 * (x + x.transpose());
  }
  throw_unsolvable();
}

SampledSystem sampled(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double period_s) {
  const Eigen::Index n = a.rows();
  const Eigen::Index m = b.cols();
  Eigen::MatrixXd exponent = Eigen::MatrixXd::Zero(n + m, n + m);
  exponent.topLeftCorner(n, n) = a * period_s;
  exponent.topRightCorner(n, m) = b * period_s;
  const Eigen::MatrixXd sum = exponent.exp();
  return {sum.topLeftCorner(n, n), sum.topRightCorner(n, m)};
}

}  // namespace nadir::control_client
