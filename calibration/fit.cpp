#include "calibration/fit.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "calibration/residual_field.h"
#include "vision/input/input_error.h"

namespace nadir::calibration {
namespace {

constexpr int kOrder = 2;
constexpr int kTerms = polynomial_terms(kOrder);
/// Smallest pivot against the largest. A line of points with an error of 1 px in 1000 leaves
/// second-order terms of 1e-6; a strip a hundredth as wide as long, 1e-4.
constexpr double kRankThreshold = 1e-5;
/// Taken as the noise where exactly six points leave no residual and none is stated.
constexpr double kAssumedPixelNoise_px = 1.0;

using DesignMatrix = Eigen::Matrix<double, Eigen::Dynamic, kTerms>;

vision::InputError error_at(const FieldPoints& points, int line, const std::string& cause,
                            const std::string& remedy) {
  return {{points.file, line, 0}, cause, remedy};
}

void check_numbers(const FieldPoints& points) {
  if (points.points.size() < kTerms) {
    throw error_at(
        points, 0,
        "holds " + std::to_string(points.points.size()) + " points, too few for polynomial2",
        "give at least 6, better 20, spread to the corners of the field");
  }
  for (const FieldPoint& point : points.points) {
    if (point.pixel.allFinite() && point.position_m.allFinite()) continue;
    throw error_at(points, point.line, "a number is not finite", "correct or remove the point");
  }
}

void check_duplicates(const FieldPoints& points) {
  std::map<std::pair<double, double>, const FieldPoint*> seen;
  for (const FieldPoint& point : points.points) {
    const auto [entry, is_new] = seen.try_emplace({point.pixel.x(), point.pixel.y()}, &point);
    if (is_new || entry->second->position_m == point.position_m) continue;
    throw error_at(points, point.line,
                   "the pixel of line " + std::to_string(entry->second->line) +
                       " stands here again with another place in metres",
                   "remove the wrong one of the two");
  }
}

/// The image of a plane is neither a line nor folded: the Jacobian's determinant keeps its sign.
void check_orientation(const PlaneMap& map, const FieldPoints& points) {
  const double first = map.jacobian_m_per_px(points.points.front().pixel).determinant();
  for (const FieldPoint& point : points.points) {
    const Eigen::Matrix2d jacobian = map.jacobian_m_per_px(point.pixel);
    const double determinant = jacobian.determinant();
    if (std::abs(determinant) > kRankThreshold * jacobian.squaredNorm() &&
        determinant * first > 0.0) {
      continue;
    }
    throw error_at(
        points, point.line,
        "the fitted map collapses or folds here: pixels and metres do not belong together",
        "check that x_m and y_m both vary, and that no rows are mixed up");
  }
}

Eigen::Vector2d mean_noise_variance_m2(const PlaneMap& map, const FieldPoints& points,
                                       const StatedNoise& noise) {
  Eigen::Vector2d sum_m2 = Eigen::Vector2d::Zero();
  for (const FieldPoint& point : points.points) {
    sum_m2 += noise.variance_m2(map.jacobian_m_per_px(point.pixel));
  }
  return sum_m2 / static_cast<double>(points.points.size());
}

/// Exactly six points leave no residual: the noise is the stated one, or else that of one pixel,
/// which then counts as lack of fit too.
ResidualEstimate estimate_without_residuals(const PlaneMap& map, const FieldPoints& points,
                                            const StatedNoise& noise) {
  if (noise.is_stated()) return {LackOfFit(), mean_noise_variance_m2(map, points, noise)};
  const Eigen::Vector2d assumed_m2 =
      mean_noise_variance_m2(map, points, {kAssumedPixelNoise_px, std::nullopt});
  return {LackOfFit::uniform(assumed_m2.mean()), assumed_m2};
}

ResidualEstimate split_residuals(const PlaneMap& map, const FieldPoints& points,
                                 const StatedNoise& noise,
                                 const std::vector<PointResidual>& residuals) {
  if (residuals.size() == kTerms) return estimate_without_residuals(map, points, noise);
  const auto& parameters = std::get<PolynomialMap>(map.model()).parameters();
  FitResiduals fit{pixel_box(points),
                   {},
                   Eigen::MatrixX2d(residuals.size(), 2),
                   [centre_px = parameters.centre_px, scale_px = parameters.scale_px](
                       const vision::PixelPoint& pixel) -> Eigen::VectorXd {
                     return polynomial_basis((pixel - centre_px) / scale_px, kOrder);
                   }};
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    fit.pixels.push_back(points.points[i].pixel);
    fit.error_m.row(static_cast<Eigen::Index>(i)) = residuals[i].error_m;
  }
  std::optional<Eigen::Vector2d> stated_m2;
  if (noise.is_stated()) stated_m2 = mean_noise_variance_m2(map, points, noise);
  return estimate_residual_field(fit, stated_m2);
}

/// Coefficients and M^-1; the variances are still zero.
PolynomialMap::Parameters solve(const FieldPoints& points) {
  const PixelBox box = pixel_box(points);
  PolynomialMap::Parameters parameters;
  parameters.order = kOrder;
  parameters.centre_px = 0.5 * (box.low_px + box.high_px);
  // One point in all places has no extent; the rank then says what is wrong.
  parameters.scale_px = std::max(0.5 * (box.high_px - box.low_px).maxCoeff(), 1e-9);

  const auto rows = static_cast<Eigen::Index>(points.points.size());
  DesignMatrix design(rows, kTerms);
  Eigen::MatrixX2d places_m(rows, 2);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const FieldPoint& point = points.points[static_cast<std::size_t>(row)];
    design.row(row) =
        polynomial_basis((point.pixel - parameters.centre_px) / parameters.scale_px, kOrder);
    places_m.row(row) = point.position_m;
  }
  Eigen::ColPivHouseholderQR<DesignMatrix> qr(rows, kTerms);
  qr.setThreshold(kRankThreshold);
  qr.compute(design);
  if (qr.rank() < kTerms) {
    throw error_at(points, 0,
                   "the points do not determine polynomial2: they lie on one line or one curve of "
                   "second order",
                   "spread them over the field in at least three rows and three columns");
  }
  parameters.coefficients_m = qr.solve(places_m).transpose();
  // A P = Q R, so M^-1 = (A^T A)^-1 = P R^-1 R^-T P^T.
  using Square = Eigen::Matrix<double, kTerms, kTerms>;
  const Square r_inverse =
      qr.matrixR().topRows<kTerms>().template triangularView<Eigen::Upper>().solve(
          Square::Identity());
  const Square root = qr.colsPermutation() * r_inverse;
  parameters.information_inverse = root * root.transpose();
  return parameters;
}

}  // namespace

Eigen::Vector2d StatedNoise::variance_m2(const Eigen::Matrix2d& jacobian_m_per_px) const {
  const double pixel = pixel_px.value_or(0.0);
  const double survey = survey_m.value_or(0.0);
  return jacobian_m_per_px.rowwise().squaredNorm().array() * pixel * pixel + survey * survey;
}

FieldFit fit_polynomial2(const FieldPoints& points, const StatedNoise& noise) {
  check_numbers(points);
  check_duplicates(points);
  PolynomialMap::Parameters parameters = solve(points);
  const PlaneMap bare_map{PolynomialMap(parameters)};
  check_orientation(bare_map, points);
  const std::vector<PointResidual> residuals = point_residuals(bare_map, points);

  ResidualEstimate estimate = split_residuals(bare_map, points, noise, residuals);
  parameters.noise_variance_m2 = estimate.noise_variance_m2.mean();
  parameters.lack_of_fit = std::move(estimate.lack_of_fit);

  // 2 (n - 6) of the 2 n residual components are free: that is what pure noise leaves on average.
  const auto count = static_cast<double>(points.points.size());
  const double stated_variance_m2 = mean_noise_variance_m2(bare_map, points, noise).sum();
  const double explained_rms_m = std::sqrt(stated_variance_m2 * (count - kTerms) / count);
  return {PlaneMap{PolynomialMap(parameters)}, residuals, residual_statistics(residuals),
          explained_rms_m};
}

}  // namespace nadir::calibration
