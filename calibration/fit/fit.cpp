#include "calibration/fit/fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "calibration/diagnosis/residual_field.h"

namespace nadir::calibration {
namespace {

/// Taken as the noise where the points leave no residual and none is stated.
constexpr double kAssumedPixelNoise_px = 1.0;

/// The stated covariance of each point, m^2.
std::vector<Eigen::Matrix2d> point_covariances_m2(const PlaneMap& map, const FieldPoints& points,
                                                  const StatedNoise& noise) {
  std::vector<Eigen::Matrix2d> covariances_m2;
  covariances_m2.reserve(points.points.size());
  for (const FieldPoint& point : points.points) {
    covariances_m2.push_back(noise.covariance_m2(map.jacobian_m_per_px(point.pixel)));
  }
  return covariances_m2;
}

/// Per axis.
Eigen::Vector2d mean_variance_m2(const std::vector<Eigen::Matrix2d>& covariances_m2) {
  Eigen::Vector2d sum_m2 = Eigen::Vector2d::Zero();
  for (const Eigen::Matrix2d& covariance_m2 : covariances_m2) sum_m2 += covariance_m2.diagonal();
  return sum_m2 / static_cast<double>(covariances_m2.size());
}

ResidualEstimate estimate_without_residuals(const PlaneMap& map, const FieldPoints& points,
                                            const StatedNoise& noise) {
  if (noise.is_stated()) {
    return {LackOfFit(), mean_variance_m2(point_covariances_m2(map, points, noise))};
  }
  const StatedNoise assumed{kAssumedPixelNoise_px, std::nullopt};
  const Eigen::Vector2d assumed_m2 = mean_variance_m2(point_covariances_m2(map, points, assumed));
  return {LackOfFit::uniform(assumed_m2.mean()), assumed_m2};
}

Eigen::MatrixX2d axis_basis(const PlaneMap& map, const vision::PixelPoint& pixel) {
  return std::visit([&](const auto& model) { return model.axis_basis(pixel); }, map.model());
}

/// Of a camera's points, whose distances in the image were made small: on the plane their noise
/// differs from place to place (polynomials take all points alike). Outside of the points' hull, in
/// the corners of their box, a lens may fold: there the nearest place of the hull counts.
void be_a_camera(const PlaneMap& map, const FieldPoints& points, const StatedNoise& noise,
                 FitResiduals* fit) {
  const ConvexHull hull = pixel_hull(points);
  const StatedNoise taken = noise.is_stated() ? noise : StatedNoise{kAssumedPixelNoise_px, {}};
  const Eigen::Vector2d mean_m2 = mean_variance_m2(point_covariances_m2(map, points, taken));
  fit->basis = [&map, hull](const vision::PixelPoint& pixel) -> Eigen::MatrixX2d {
    return axis_basis(map, hull.nearest(pixel));
  };
  fit->noise_scale = [&map, hull, taken, mean_m2](const vision::PixelPoint& pixel) {
    const Eigen::Matrix2d jacobian = map.jacobian_m_per_px(hull.nearest(pixel));
    return Eigen::Vector2d(taken.variance_m2(jacobian).cwiseQuotient(mean_m2).cwiseSqrt());
  };
}

ResidualEstimate split_residuals(const PlaneMap& map, const FieldPoints& points,
                                 const StatedNoise& noise,
                                 const std::vector<PointResidual>& residuals) {
  FitResiduals fit{pixel_box(points),
                   {},
                   Eigen::MatrixX2d(residuals.size(), 2),
                   [&map](const vision::PixelPoint& pixel) { return axis_basis(map, pixel); }};
  const auto terms = static_cast<std::size_t>(fit.basis(points.points.front().pixel).rows());
  if (residuals.size() <= terms) return estimate_without_residuals(map, points, noise);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    fit.pixels.push_back(points.points[i].pixel);
    fit.error_m.row(static_cast<Eigen::Index>(i)) = residuals[i].error_m;
  }
  const bool is_noisy = noise.pixel_px.value_or(0.0) > 0.0 || noise.survey_m.value_or(0.0) > 0.0;
  if (polynomial_order(map.kind()) == 0 && (is_noisy || !noise.is_stated())) {
    be_a_camera(map, points, noise, &fit);
  }
  std::optional<Eigen::Vector2d> stated_m2;
  if (noise.is_stated()) stated_m2 = mean_variance_m2(point_covariances_m2(map, points, noise));
  return estimate_residual_field(fit, stated_m2);
}

/// inverse spread inverse, by way of a root of the spread: what is nearly singular stays symmetric
/// and without negative eigenvalues.
Eigen::MatrixXd sandwich(const Eigen::MatrixXd& inverse, const Eigen::MatrixXd& spread) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(spread);
  const Eigen::VectorXd roots = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  const Eigen::MatrixXd root = inverse * (solver.eigenvectors() * roots.asDiagonal());
  const Eigen::MatrixXd product = root * root.transpose();
  return 0.5 * (product + product.transpose());
}

/// M^-1 (sum of w phi phi^T) M^-1, w: the variance of a point against the mean one.
PolynomialMap weighted(const PolynomialMap& map, const FieldPoints& points,
                       const std::vector<Eigen::Matrix2d>& covariances_m2, double mean_m2) {
  PolynomialMap::Parameters p = map.parameters();
  const Eigen::Index terms = p.information_inverse.rows();
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(terms, terms);
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const PolynomialBasis phi =
        polynomial_basis((points.points[i].pixel - p.centre_px) / p.scale_px, p.order);
    spread += 0.5 * covariances_m2[i].trace() / mean_m2 * phi * phi.transpose();
  }
  p.information_inverse = sandwich(p.information_inverse, spread);
  return PolynomialMap(p);
}

/// s^4 M^-1 (sum of G^T W G) M^-1, W: the covariance of a point in the image against the mean
/// variance on the plane.
RadialMap weighted(const RadialMap& map, const FieldPoints& points,
                   const std::vector<Eigen::Matrix2d>& covariances_m2, double mean_m2) {
  RadialMap::Parameters p = map.parameters();
  RadialInformation spread =
      RadialInformation::Zero(p.information_inverse.rows(), p.information_inverse.cols());
  double scale_m2 = 0.0;
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const Eigen::Matrix2d jacobian = map.jacobian_m_per_px(points.points[i].pixel);
    const Eigen::Matrix2d inverse = jacobian.inverse();
    const RadialParameterJacobian in_image =
        inverse * map.parameter_jacobian(points.points[i].pixel);
    spread += in_image.transpose() * inverse * (covariances_m2[i] / mean_m2) * inverse.transpose() *
              in_image;
    scale_m2 += 0.5 * jacobian.squaredNorm() / static_cast<double>(points.points.size());
  }
  p.information_inverse = scale_m2 * scale_m2 * sandwich(p.information_inverse, spread);
  return RadialMap(p);
}

/// The map with its parameters' sampling error, for points with this mean variance.
PlaneMap with_noise(const PlaneMap& map, const FieldPoints& points, const StatedNoise& noise,
                    double variance_m2, MapSupport support) {
  const auto covariances_m2 = point_covariances_m2(map, points, noise);
  return std::visit(
      [&](const auto& model) {
        using Model = std::decay_t<decltype(model)>;
        const bool varies = noise.is_stated() && variance_m2 > 0.0;
        auto parameters =
            (varies ? weighted(model, points, covariances_m2, variance_m2) : model).parameters();
        parameters.noise_variance_m2 = variance_m2;
        return PlaneMap(Model(parameters), std::move(support));
      },
      map.model());
}

}  // namespace

Eigen::Matrix2d StatedNoise::covariance_m2(const Eigen::Matrix2d& jacobian_m_per_px) const {
  const double pixel = pixel_px.value_or(0.0);
  const double survey = survey_m.value_or(0.0);
  return pixel * pixel * jacobian_m_per_px * jacobian_m_per_px.transpose() +
         survey * survey * Eigen::Matrix2d::Identity();
}

Eigen::Vector2d StatedNoise::variance_m2(const Eigen::Matrix2d& jacobian_m_per_px) const {
  return covariance_m2(jacobian_m_per_px).diagonal();
}

PlaneMap fit_sampled_map(ModelKind model, const FieldPoints& points, const StatedNoise& noise,
                         const FitOptions& options) {
  const PlaneMap map = fit_map(model, points, options);
  const double variance_m2 = mean_variance_m2(point_covariances_m2(map, points, noise)).mean();
  return with_noise(map, points, noise, variance_m2, {LackOfFit(), pixel_hull(points)});
}

FieldFit fit_field(ModelKind model, const FieldPoints& points, const StatedNoise& noise,
                   const FitOptions& options) {
  const PlaneMap bare_map = fit_map(model, points, options);
  const std::vector<PointResidual> residuals = point_residuals(bare_map, points);
  ResidualEstimate estimate = split_residuals(bare_map, points, noise, residuals);
  const PlaneMap map = with_noise(bare_map, points, noise, estimate.noise_variance_m2.mean(),
                                  {std::move(estimate.lack_of_fit), pixel_hull(points)});

  // 2 n - p of the 2 n residual components are free: that is what pure noise leaves on average.
  const auto count = static_cast<double>(points.points.size());
  const double free = std::max(0.0, 2.0 * count - parameter_count(model)) / (2.0 * count);
  const double stated_m2 = mean_variance_m2(point_covariances_m2(bare_map, points, noise)).sum();
  return {map, residuals, residual_statistics(residuals), std::sqrt(stated_m2 * free)};
}

FieldFit fit_polynomial2(const FieldPoints& points, const StatedNoise& noise) {
  return fit_field(ModelKind::kPolynomial2, points, noise);
}

}  // namespace nadir::calibration
