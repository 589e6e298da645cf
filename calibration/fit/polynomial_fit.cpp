// Polynomials by linear least squares.

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "calibration/fit/map_fit.h"

namespace nadir::calibration {
namespace {

/// Smallest pivot against the largest, for order 2. A line of points with an error of 1 px in 1000
/// leaves second-order terms of 1e-6; a strip a hundredth as wide as long, 1e-4.
constexpr double kRankThreshold = 1e-5;

ModelKind kind_of_order(int order) {
  for (const ModelKind model : kAllModels) {
    if (polynomial_order(model) == order) return model;
  }
  return ModelKind::kPolynomial2;
}

}  // namespace

PolynomialMap fit_polynomial_map(int order, const FieldPoints& points, const FitOptions& options) {
  const int terms = polynomial_terms(order);
  const PixelBox box = pixel_box(points);
  PolynomialMap::Parameters parameters;
  parameters.order = order;
  parameters.centre_px = 0.5 * (box.low_px + box.high_px);
  // One point in all places has no extent; the rank then says what is wrong.
  parameters.scale_px = std::max(0.5 * (box.high_px - box.low_px).maxCoeff(), 1e-9);

  const auto rows = static_cast<Eigen::Index>(points.points.size());
  Eigen::MatrixXd design(rows, terms);
  Eigen::MatrixX2d places_m(rows, 2);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const auto index = static_cast<std::size_t>(row);
    const FieldPoint& point = points.points[index];
    const double weight = options.weights.empty() ? 1.0 : std::sqrt(options.weights[index]);
    design.row(row) =
        weight *
        polynomial_basis((point.pixel - parameters.centre_px) / parameters.scale_px, order);
    places_m.row(row) = weight * point.position_m;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(rows, terms);
  qr.setThreshold(kRankThreshold);
  qr.compute(design);
  if (qr.rank() < terms) throw undetermined_error(kind_of_order(order), points);
  parameters.coefficients_m = qr.solve(places_m).transpose();
  // A P = Q R, so M^-1 = (A^T A)^-1 = P R^-1 R^-T P^T.
  const Eigen::MatrixXd r_inverse =
      qr.matrixR().topRows(terms).triangularView<Eigen::Upper>().solve(
          Eigen::MatrixXd::Identity(terms, terms));
  const Eigen::MatrixXd root = qr.colsPermutation() * r_inverse;
  parameters.information_inverse = root * root.transpose();
  return PolynomialMap(parameters);
}

}  // namespace nadir::calibration
