#include "calibration/polynomial_map.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <stdexcept>

namespace nadir::calibration {
namespace {

constexpr double kInverseTolerance_m = 1e-9;
constexpr int kMaxNewtonSteps = 50;

/// 1, t, t^2, ... up to t^order.
std::array<double, kMaxPolynomialOrder + 1> powers(double t, int order) {
  std::array<double, kMaxPolynomialOrder + 1> power{};
  power[0] = 1.0;
  for (int k = 1; k <= order; ++k) power[k] = power[k - 1] * t;
  return power;
}

/// dphi/d(u, v) of polynomial_basis: terms x 2.
Eigen::Matrix<double, Eigen::Dynamic, 2, 0, kMaxPolynomialTerms, 2> basis_derivative(
    const Eigen::Vector2d& normalised, int order) {
  Eigen::Matrix<double, Eigen::Dynamic, 2, 0, kMaxPolynomialTerms, 2> derivative(
      polynomial_terms(order), 2);
  const auto u = powers(normalised.x(), order);
  const auto v = powers(normalised.y(), order);
  int term = 0;
  for (int degree = 0; degree <= order; ++degree) {
    for (int k = 0; k <= degree; ++k, ++term) {
      const int a = degree - k;  // the term is u^a v^k
      derivative(term, 0) = a == 0 ? 0.0 : a * u[a - 1] * v[k];
      derivative(term, 1) = k == 0 ? 0.0 : k * u[a] * v[k - 1];
    }
  }
  return derivative;
}

void check(const PolynomialMap::Parameters& parameters) {
  if (parameters.order < 1 || parameters.order > kMaxPolynomialOrder) {
    throw std::invalid_argument("polynomial map: order out of range");
  }
  const int terms = polynomial_terms(parameters.order);
  const auto& information = parameters.information_inverse;
  if (parameters.coefficients_m.cols() != terms || information.rows() != terms ||
      information.cols() != terms) {
    throw std::invalid_argument("polynomial map: sizes do not belong to the order");
  }
  if (!(parameters.scale_px > 0.0) || !(parameters.noise_variance_m2 >= 0.0) ||
      !parameters.coefficients_m.allFinite() || !information.allFinite() ||
      !parameters.centre_px.allFinite()) {
    throw std::invalid_argument("polynomial map: number out of range");
  }
}

}  // namespace

PolynomialBasis polynomial_basis(const Eigen::Vector2d& normalised, int order) {
  PolynomialBasis basis(polynomial_terms(order));
  const auto u = powers(normalised.x(), order);
  const auto v = powers(normalised.y(), order);
  int term = 0;
  for (int degree = 0; degree <= order; ++degree) {
    for (int k = 0; k <= degree; ++k) basis[term++] = u[degree - k] * v[k];
  }
  return basis;
}

PolynomialMap::PolynomialMap(const Parameters& parameters) : parameters_(parameters) {
  check(parameters_);
}

Eigen::Vector2d PolynomialMap::plane_from_pixel(const vision::PixelPoint& pixel) const {
  return parameters_.coefficients_m * polynomial_basis(normalised(pixel), parameters_.order);
}

Eigen::Matrix2d PolynomialMap::jacobian_m_per_px(const vision::PixelPoint& pixel) const {
  return parameters_.coefficients_m * basis_derivative(normalised(pixel), parameters_.order) /
         parameters_.scale_px;
}

double PolynomialMap::leverage(const vision::PixelPoint& pixel) const {
  const PolynomialBasis phi = polynomial_basis(normalised(pixel), parameters_.order);
  return phi.dot(parameters_.information_inverse * phi);
}

double PolynomialMap::sampling_variance_m2(const vision::PixelPoint& pixel) const {
  return parameters_.noise_variance_m2 * leverage(pixel);
}

Eigen::MatrixX2d PolynomialMap::axis_basis(const vision::PixelPoint& pixel) const {
  return polynomial_basis(normalised(pixel), parameters_.order).replicate<1, 2>();
}

std::optional<vision::PixelPoint> PolynomialMap::pixel_from_plane(
    const Eigen::Vector2d& plane_m) const {
  // The first step from the centre is the linear guess: pixel += J^-1 (wanted - map(pixel)).
  vision::PixelPoint pixel = centre_px();
  const double orientation = jacobian_m_per_px(pixel).determinant();
  for (int step = 0; step < kMaxNewtonSteps; ++step) {
    const Eigen::Vector2d error_m = plane_m - plane_from_pixel(pixel);
    const Eigen::Matrix2d jacobian = jacobian_m_per_px(pixel);
    const double determinant = jacobian.determinant();
    if (determinant == 0.0 || !error_m.allFinite()) return std::nullopt;
    if (error_m.norm() <= kInverseTolerance_m) {
      if (determinant * orientation <= 0.0) return std::nullopt;
      return pixel;
    }
    pixel += jacobian.inverse() * error_m;
  }
  return std::nullopt;
}

ModelKind PolynomialMap::kind() const {
  for (const ModelKind model : kAllModels) {
    if (polynomial_order(model) == parameters_.order) return model;
  }
  throw std::logic_error("a polynomial of this order has no name");
}

}  // namespace nadir::calibration
