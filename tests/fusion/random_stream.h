#pragma once

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace nadir::fusion::test {

/// Random numbers that are the same on every machine: SplitMix64, normals by Box and Muller's
/// cosine (theory 11).
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed) : state_(seed) {}

  double uniform(double from = 0.0, double to = 1.0) {
    return from + (to - from) * static_cast<double>(next() >> 11) * 0x1p-53;
  }
  bool happens(double probability) { return uniform() < probability; }
  int whole(int from, int to) {  ///< both ends included
    return from + static_cast<int>(next() % static_cast<std::uint64_t>(to - from + 1));
  }
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }
  Eigen::Vector3d normal(const Eigen::Matrix3d& covariance) {
    const double a = normal();
    const double b = normal();
    const double c = normal();
    return Eigen::LLT<Eigen::Matrix3d>(covariance).matrixL() * Eigen::Vector3d(a, b, c);
  }

 private:
  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace nadir::fusion::test
