#include "calibration/validation.h"

#include <Eigen/Cholesky>

namespace nadir::calibration {
namespace {

/// 95 % quantile of chi-square with two degrees of freedom, -2 ln 0.05.
constexpr double kChiSquare95 = 5.991464547107979;

Eigen::Matrix2d predicted_covariance_m2(const Calibration& calibration,
                                        const vision::PixelPoint& pixel) {
  const double pixel_px = calibration.noise.pixel_px.value_or(0.0);
  const double survey_m = calibration.noise.survey_m.value_or(0.0);
  return calibration.map.map(pixel, pixel_px * pixel_px * Eigen::Matrix2d::Identity())
             .covariance_m2 +
         survey_m * survey_m * Eigen::Matrix2d::Identity();
}

/// Whether the error lies in the ellipse; without any covariance only a zero error does.
bool is_covered(const Eigen::Vector2d& error_m, const Eigen::Matrix2d& covariance_m2) {
  const Eigen::LLT<Eigen::Matrix2d> factor(covariance_m2);
  if (factor.info() != Eigen::Success) return error_m.isZero(0.0);
  return error_m.dot(factor.solve(error_m)) <= kChiSquare95;
}

}  // namespace

Validation validate(const Calibration& calibration, const FieldPoints& points) {
  const std::vector<PointResidual> residuals = point_residuals(calibration.map, points);
  int covered = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const vision::PixelPoint& pixel = points.points[i].pixel;
    if (is_covered(residuals[i].error_m, predicted_covariance_m2(calibration, pixel))) ++covered;
  }
  return {residual_statistics(residuals), covered / static_cast<double>(residuals.size())};
}

}  // namespace nadir::calibration
