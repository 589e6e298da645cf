#pragma once

#include <Eigen/Core>

namespace nadir::fusion::test {

/// Central differences of a function from N numbers to M numbers.
template <int M, int N, class Function>
Eigen::Matrix<double, M, N> numeric_jacobian(const Function& function,
                                             const Eigen::Matrix<double, N, 1>& at,
                                             double step = 1e-5) {
  Eigen::Matrix<double, M, N> jacobian;
  for (int i = 0; i < N; ++i) {
    Eigen::Matrix<double, N, 1> up = at;
    Eigen::Matrix<double, N, 1> down = at;
    up[i] += step;
    down[i] -= step;
    jacobian.col(i) = (function(up) - function(down)) / (2.0 * step);
  }
  return jacobian;
}

}  // namespace nadir::fusion::test
