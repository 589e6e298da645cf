#pragma once

#include <Eigen/Core>

namespace nadir::control_client {

/// The stabilising solution X of A^T X + X A - X B R^-1 B^T X + Q = 0 (n x n) by the matrix sign
/// function of the Hamiltonian (Roberts 1980). A: n x n, B: n x m, Q >= 0, R > 0. (A, B) must be
/// stabilisable and (Q, A) detectable, else throws std::invalid_argument.
Eigen::MatrixXd solve_continuous_riccati(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                                         const Eigen::MatrixXd& q, const Eigen::MatrixXd& r);

/// The stabilising solution X of X = A^T X A - A^T X B (R + B^T X B)^-1 B^T X A + Q by doubling
/// (Chu, Fan, Lin 2005). As above.
Eigen::MatrixXd solve_discrete_riccati(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                                       const Eigen::MatrixXd& q, const Eigen::MatrixXd& r);

/// exp([A B; 0 0] T): the first n rows are A and B of a period with constant input.
struct SampledSystem {
  Eigen::MatrixXd a;
  Eigen::MatrixXd b;
};
SampledSystem sampled(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double period_s);

}  // namespace nadir::control_client
