// Homographies and radial maps: linear start, then Levenberg-Marquardt on the distances in the
// image, where the points' noise is the same everywhere although the lens stretches its border.

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/fit/map_fit.h"

namespace nadir::calibration {
namespace {

using Eigen::Index;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxRadialParameters, 1>;

/// Smallest pivot of the linear equations against the largest.
constexpr double kRankThreshold = 1e-5;
/// Directions of the parameters that move the points less than this, against the one that moves
/// them most, are not known from them: the centre of a lens that distorts nothing.
constexpr double kLeastSingular = 1e-7;
constexpr int kMaxSteps = 200;
constexpr double kFirstDamping = 1e-3;
constexpr double kMostDamping = 1e12;
/// Relative step, in units in which every parameter alone moves the points alike.
constexpr double kSmallestStep = 1e-13;
/// The lens centre stays within this many scales of where it started, distortions within this.
constexpr double kMostCentreMove = 1.5;
constexpr double kMostDistortion = 5.0;

/// The parameters as one vector, about the centre from which the fit starts.
struct Problem {
  const FieldPoints& points;
  const FitOptions& options;
  ModelKind kind;
  vision::PixelPoint origin_px;
  double scale_px;

  RadialMap map(const Vector& p) const {
    RadialMap::Parameters parameters;
    parameters.kind = kind;
    parameters.centre_px = origin_px;
    parameters.scale_px = scale_px;
    parameters.homography_m << p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], 1.0;
    if (p.size() > 8) parameters.k1 = p[8];
    if (p.size() > 9) {
      parameters.k2 = p[9];
      parameters.centre_px += scale_px * p.tail<2>();
    }
    parameters.information_inverse = RadialInformation::Zero(p.size(), p.size());
    return RadialMap(parameters);
  }
  bool is_sound(const Vector& p) const {
    if (!p.allFinite()) return false;
    if (p.size() > 8 && std::abs(p[8]) > kMostDistortion) return false;
    return p.size() <= 9 || (std::abs(p[9]) <= kMostDistortion &&
                             p.tail<2>().cwiseAbs().maxCoeff() <= kMostCentreMove);
  }
  double weight(std::size_t index) const {
    return options.weights.empty() ? 1.0 : options.weights[index];
  }
};

/// Sum of squared distances in the image; infinity where a place has no image.
double cost_px2(const Problem& problem, const Vector& p) {
  if (!problem.is_sound(p)) return std::numeric_limits<double>::infinity();
  const RadialMap map = problem.map(p);
  double sum_px2 = 0.0;
  for (std::size_t i = 0; i < problem.points.points.size(); ++i) {
    const FieldPoint& point = problem.points.points[i];
    const auto pixel = map.pixel_from_plane(point.position_m);
    if (!pixel) return std::numeric_limits<double>::infinity();
    sum_px2 += problem.weight(i) * (point.pixel - *pixel).squaredNorm();
  }
  return std::isfinite(sum_px2) ? sum_px2 : std::numeric_limits<double>::infinity();
}

/// d pixel/d parameters for a place whose image is `pixel`. The place does not move:
/// 0 = J dpixel + D dparameters.
RadialParameterJacobian pixel_jacobian(const RadialMap& map, const vision::PixelPoint& pixel) {
  return -map.jacobian_m_per_px(pixel).inverse() * map.parameter_jacobian(pixel);
}

/// G^T G and G^T r of the weighted residuals.
struct NormalEquations {
  RadialInformation matrix;
  Vector right;
};

/// Where the cost is finite.
NormalEquations normal_equations(const Problem& problem, const Vector& p) {
  const RadialMap map = problem.map(p);
  NormalEquations equations{RadialInformation::Zero(p.size(), p.size()), Vector::Zero(p.size())};
  for (std::size_t i = 0; i < problem.points.points.size(); ++i) {
    const FieldPoint& point = problem.points.points[i];
    const vision::PixelPoint pixel = map.pixel_from_plane(point.position_m).value_or(point.pixel);
    const RadialParameterJacobian jacobian = pixel_jacobian(map, pixel);
    equations.matrix.noalias() += problem.weight(i) * jacobian.transpose() * jacobian;
    equations.right.noalias() += problem.weight(i) * jacobian.transpose() * (point.pixel - pixel);
  }
  return equations;
}

/// Levenberg-Marquardt with Marquardt's scaling; returns where no step helps any more.
Vector minimised(const Problem& problem, Vector p) {
  double damping = kFirstDamping;
  double cost = cost_px2(problem, p);
  for (int step = 0; step < kMaxSteps; ++step) {
    const NormalEquations equations = normal_equations(problem, p);
    const Vector scale = equations.matrix.diagonal().cwiseSqrt().cwiseMax(
        1e-12 * std::sqrt(equations.matrix.diagonal().maxCoeff()));
    const Vector scale_inverse = scale.cwiseInverse();
    RadialInformation scaled =
        scale_inverse.asDiagonal() * equations.matrix * scale_inverse.asDiagonal();
    const Vector right = scale_inverse.cwiseProduct(equations.right);
    double moved = 0.0;
    bool is_better = false;
    while (!is_better && damping < kMostDamping) {
      RadialInformation damped = scaled;
      damped.diagonal().array() += damping;
      const Vector scaled_step = damped.ldlt().solve(right);
      const Vector next = p + scale_inverse.cwiseProduct(scaled_step);
      const double next_cost = cost_px2(problem, next);
      is_better = next_cost <= cost;
      damping = is_better ? std::max(damping * 0.1, 1e-15) : damping * 10.0;
      if (!is_better) continue;
      moved = scaled_step.norm() / std::max(scale.cwiseProduct(p).norm(), 1e-300);
      p = next;
      cost = next_cost;
    }
    if (!is_better || moved <= kSmallestStep) break;
  }
  return p;
}

/// The homography from the linear equations x (h2 . m) = h0 . m, y (h2 . m) = h1 . m.
Vector linear_start(const Problem& problem) {
  const auto count = static_cast<Index>(problem.points.points.size());
  // Places are centred and scaled too: x n is to be as large as n.
  Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
  for (const FieldPoint& point : problem.points.points) middle_m += point.position_m;
  middle_m /= static_cast<double>(count);
  double extent_m = 0.0;
  for (const FieldPoint& point : problem.points.points) {
    extent_m = std::max(extent_m, (point.position_m - middle_m).cwiseAbs().maxCoeff());
  }
  if (extent_m == 0.0) throw undetermined_error(problem.kind, problem.points);
  Eigen::MatrixXd design = Eigen::MatrixXd::Zero(2 * count, 8);
  Eigen::VectorXd places(2 * count);
  for (Index i = 0; i < count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const FieldPoint& point = problem.points.points[index];
    const double weight = std::sqrt(problem.weight(index));
    const Eigen::Vector2d n = (point.pixel - problem.origin_px) / problem.scale_px;
    const Eigen::Vector2d place = (point.position_m - middle_m) / extent_m;
    for (Index axis = 0; axis < 2; ++axis) {
      design.block<1, 3>(2 * i + axis, 3 * axis) << n.x(), n.y(), 1.0;
      design.block<1, 2>(2 * i + axis, 6) = -place[axis] * n.transpose();
      design.row(2 * i + axis) *= weight;
      places[2 * i + axis] = weight * place[axis];
    }
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(2 * count, 8);
  qr.setThreshold(kRankThreshold);
  qr.compute(design);
  if (qr.rank() < 8) throw undetermined_error(problem.kind, problem.points);
  const Eigen::VectorXd h = qr.solve(places);
  Eigen::Matrix3d homography;
  homography << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1.0;
  Eigen::Matrix3d to_metres;
  to_metres << extent_m, 0.0, middle_m.x(), 0.0, extent_m, middle_m.y(), 0.0, 0.0, 1.0;
  const Eigen::Matrix3d m = to_metres * homography;
  Vector start(8);
  start << m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1);
  return start;
}

Vector appended(const Vector& p, Index zeros) {
  Vector longer = Vector::Zero(p.size() + zeros);
  longer.head(p.size()) = p;
  return longer;
}

/// M^-1 from the singular values of the scaled design, without the directions that are not known.
/// It is for a noise in square metres: that of a pixel times the mean square scale.
RadialInformation information_inverse(const Problem& problem, const Vector& p) {
  const RadialMap map = problem.map(p);
  const auto count = static_cast<Index>(problem.points.points.size());
  Eigen::MatrixXd design(2 * count, p.size());
  double scale_m2 = 0.0;  // of a pixel
  for (Index i = 0; i < count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const vision::PixelPoint& pixel = problem.points.points[index].pixel;
    design.middleRows<2>(2 * i) = std::sqrt(problem.weight(index)) * pixel_jacobian(map, pixel);
    scale_m2 += 0.5 * map.jacobian_m_per_px(pixel).squaredNorm() / static_cast<double>(count);
  }
  const Eigen::VectorXd norms = design.colwise().norm();
  const double largest = norms.maxCoeff();
  const Eigen::VectorXd scale_inverse = norms.cwiseMax(1e-12 * largest).cwiseInverse();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(design * scale_inverse.asDiagonal());
  const Eigen::MatrixXd r = qr.matrixQR().topRows(p.size()).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(r, Eigen::ComputeFullV);
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(p.size());
  for (Index i = 0; i < p.size(); ++i) {
    const double singular = svd.singularValues()[i];
    if (singular > kLeastSingular * svd.singularValues()[0]) inverse[i] = 1.0 / singular;
  }
  const Eigen::MatrixXd root =
      scale_inverse.asDiagonal() * svd.matrixV() * inverse.asDiagonal().toDenseMatrix();
  return root * root.transpose() / scale_m2;
}

}  // namespace

RadialMap fit_radial_map(ModelKind model, const FieldPoints& points, const FitOptions& options) {
  const PixelBox box = pixel_box(points);
  const vision::PixelPoint middle_px = 0.5 * (box.low_px + box.high_px);
  const Problem lens{points, options, model, options.lens_centre_px.value_or(middle_px),
                     std::max(0.5 * (box.high_px - box.low_px).maxCoeff(), 1e-9)};
  Problem pinhole = lens;
  pinhole.kind = ModelKind::kHomography;
  Vector p = minimised(pinhole, linear_start(lens));
  if (model != ModelKind::kHomography) {
    Problem first = lens;
    first.kind = ModelKind::kRadial;
    p = minimised(first, appended(p, 1));
  }
  if (model == ModelKind::kRadial2) p = minimised(lens, appended(p, 3));
  RadialMap::Parameters parameters = lens.map(p).parameters();
  parameters.information_inverse = information_inverse(lens, p);
  return RadialMap(parameters);
}

}  // namespace nadir::calibration
