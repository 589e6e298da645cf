#include "fusion/extended_state_observer.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace nadir::fusion {
namespace {

/// Of the errors between measurements: s^3 + lx s^2 + lv s + ld / mu is its characteristic
/// polynomial.
Eigen::Matrix3d error_matrix(const ObserverGains& gains, double inertia) {
  Eigen::Matrix3d a;
  a << -gains.position_per_s, 1.0, 0.0,  //
      -gains.velocity_per_s2, 0.0, 1.0,  //
      -gains.disturbance_n_per_m_per_s / inertia, 0.0, 0.0;
  return a;
}

/// exp(a): Taylor series of a / 2^n, squared n times.
Eigen::Matrix3d exponential(const Eigen::Matrix3d& a) {
  const double norm = a.cwiseAbs().rowwise().sum().maxCoeff();
  const int halvings =
      std::max(0, static_cast<int>(std::ceil(std::log2(std::max(norm, 1e-9)))) + 3);
  const Eigen::Matrix3d small = std::ldexp(1.0, -halvings) * a;
  Eigen::Matrix3d term = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d sum = term;
  for (int k = 1; k <= 14; ++k) {
    term = (term * small / k).eval();
    sum += term;
  }
  for (int k = 0; k < halvings; ++k) sum = (sum * sum).eval();
  return sum;
}

/// k1, k2, mu k3. The coefficients of p come from exp(A T) itself, not from its roots, which are
/// known badly where they coincide.
Eigen::Vector3d correction(const ObserverGains& gains, double inertia, double tick_s) {
  const Eigen::Matrix3d e = exponential(tick_s * error_matrix(gains, inertia));
  const double trace = e.trace();
  const double c2 = -trace;
  const double c1 = 0.5 * (trace * trace - (e * e).trace());
  const double c0 = -e.determinant();
  const double at_one = 1.0 + c2 + c1 + c0;
  const double k1 = 1.0 + c0;
  return {k1, (c2 + 3.0 - k1 - 0.5 * at_one) / tick_s, inertia * at_one / (tick_s * tick_s)};
}

}  // namespace

ObserverGains gains_of_bandwidth(double bandwidth_radps, double inertia) {
  const double w = bandwidth_radps;
  return {3.0 * w, 3.0 * w * w, w * w * w * inertia};
}

ObserverStability observer_stability(const ObserverGains& gains, double inertia) {
  ObserverStability result;
  const double constant = gains.disturbance_n_per_m_per_s / inertia;
  result.routh_margin_per_s3 = gains.position_per_s * gains.velocity_per_s2 - constant;
  result.is_stable =
      gains.position_per_s > 0.0 && constant > 0.0 && result.routh_margin_per_s3 > 0.0;
  const Eigen::Vector3cd roots = error_matrix(gains, inertia).eigenvalues();
  std::copy(roots.begin(), roots.end(), result.poles.begin());
  std::sort(result.poles.begin(), result.poles.end(), [](const auto& a, const auto& b) {
    return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
  });
  return result;
}

std::string ObserverStability::text() const {
  std::string out = is_stable ? "stable" : "unstable";
  char words[64];
  std::snprintf(words, sizeof words, ": Routh margin %+.3g", routh_margin_per_s3);
  out += words;
  out += ", poles";
  for (const auto& pole : poles) {
    const double imaginary = std::abs(pole.imag()) < 1e-3 * std::abs(pole) ? 0.0 : pole.imag();
    if (imaginary == 0.0) {
      std::snprintf(words, sizeof words, " %+.2f", pole.real());
    } else {
      std::snprintf(words, sizeof words, " %+.2f%+.2fj", pole.real(), imaginary);
    }
    out += words;
  }
  return out;
}

ExtendedStateObserver::ExtendedStateObserver(const std::array<ObserverGains, 3>& gains,
                                             const Eigen::Vector3d& inertia, double tick_s)
    : inertia_(inertia), tick_s_(tick_s) {
  for (int axis = 0; axis < 3; ++axis) {
    gain_.col(axis) = correction(gains[static_cast<std::size_t>(axis)], inertia[axis], tick_s);
  }
}

void ExtendedStateObserver::start(const PlanarPose& pose) {
  pose_ = pose;
  velocity_.setZero();
  disturbance_.setZero();
}

Eigen::Vector3d ExtendedStateObserver::predict(const Eigen::Vector3d& force) {
  const Eigen::Vector3d acceleration = (force + disturbance_).cwiseQuotient(inertia_);
  Eigen::Vector3d displacement = tick_s_ * velocity_ + 0.5 * tick_s_ * tick_s_ * acceleration;
  pose_ = {pose_.x_m + displacement.x(), pose_.y_m + displacement.y(),
           wrap_angle(pose_.heading_rad + displacement.z())};
  velocity_ += tick_s_ * acceleration;
  return displacement;
}

void ExtendedStateObserver::correct(const PlanarPose& measured) {
  const Eigen::Vector3d error = pose_difference(measured, pose_);
  const Eigen::Vector3d step = gain_.row(0).transpose().cwiseProduct(error);
  pose_ = {pose_.x_m + step.x(), pose_.y_m + step.y(), wrap_angle(pose_.heading_rad + step.z())};
  velocity_ += gain_.row(1).transpose().cwiseProduct(error);
  disturbance_ += gain_.row(2).transpose().cwiseProduct(error);
}

}  // namespace nadir::fusion
