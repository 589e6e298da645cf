#include "calibration/diagnosis.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <numeric>

namespace nadir::calibration {
namespace {

/// The residual must be this many times what the noise leaves before the model is blamed.
constexpr double kMisfitRatio = 2.0;
/// Corners are found to well below a pixel; more than this asks for an explanation even where no
/// noise is stated.
constexpr double kUsualResidual_px = 1.0;
/// A point stands out at this many medians (7 sigma of a Gaussian in two dimensions) and at this
/// many pixels.
constexpr double kOutlierMedians = 6.0;
constexpr double kOutlierLeast_px = 0.1;
constexpr std::size_t kNamedOutliers = 5;
constexpr int kComfortablePoints = 20;
/// Below this share of the stated noise, or of a pixel where none is stated, points agree too well
/// to be measured.
constexpr double kTooGoodRatio = 0.3;
constexpr double kTooGood_px = 1e-3;

double median_distance_m(const FieldFit& fit) {
  std::vector<double> distances;
  for (const PointResidual& residual : fit.point_residuals)
    distances.push_back(residual.distance_m);
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

std::string misfit_remark(const StatedNoise& noise, const FieldFit& fit) {
  const std::string left = fmt::format("polynomial2 leaves {:.3g} mm RMS ({:.2g} px)",
                                       1e3 * fit.residuals.rms_m, fit.residuals.rms_px);
  if (noise.is_stated() && fit.residuals.rms_m > kMisfitRatio * fit.explained_rms_m) {
    return fmt::format(
        "{}, the stated noise explains {:.2g} mm: the model does not fit. A second-order "
        "polynomial cannot "
        "follow radial lens distortion. What is unexplained counts as error of the positions near "
        "by.",
        left, 1e3 * fit.explained_rms_m);
  }
  if (!noise.is_stated() && fit.residuals.rms_px > kUsualResidual_px) {
    return left +
           ", more than the usual error of finding a point: the model probably does not fit. A "
           "second-order "
           "polynomial cannot follow radial lens distortion.";
  }
  return {};
}

/// Residuals say nothing of the calibration's error where points were computed or the noise is
/// overstated.
std::string too_good_remark(const StatedNoise& noise, const FieldFit& fit) {
  const bool is_below_noise =
      noise.is_stated() && fit.residuals.rms_m < kTooGoodRatio * fit.explained_rms_m;
  const bool is_exact = fit.residuals.rms_px < kTooGood_px;
  if (!is_below_noise && !is_exact) return {};
  if (fit.residuals.points == polynomial_terms(2)) {
    return "six points always fit: their residual says nothing about the error.";
  }
  return fmt::format(
      "the points agree to {:.2g} px, better than they can be measured{}: were they computed? The "
      "calibration's own error is then not known from them.",
      fit.residuals.rms_px, is_below_noise ? " by the stated noise" : "");
}

std::string outlier_remark(const FieldPoints& points, const FieldFit& fit) {
  const double limit_m = kOutlierMedians * median_distance_m(fit);
  std::string lines;
  for (const std::size_t index : worst_points(fit, kNamedOutliers)) {
    const PointResidual& residual = fit.point_residuals[index];
    if (residual.distance_m <= limit_m || residual.distance_px <= kOutlierLeast_px) break;
    lines += fmt::format("{}line {} ({:.3g} mm)", lines.empty() ? "" : ", ",
                         points.points[index].line, 1e3 * residual.distance_m);
  }
  if (lines.empty()) return {};
  return fmt::format("stands out against a median of {:.3g} mm: {}. A typing error?",
                     1e3 * median_distance_m(fit), lines);
}

}  // namespace

std::vector<std::size_t> worst_points(const FieldFit& fit, std::size_t count) {
  std::vector<std::size_t> order(fit.point_residuals.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&fit](std::size_t a, std::size_t b) {
    return fit.point_residuals[a].distance_m > fit.point_residuals[b].distance_m;
  });
  order.resize(std::min(count, order.size()));
  return order;
}

std::vector<std::string> fit_remarks(const FieldPoints& points, const StatedNoise& noise,
                                     const FieldFit& fit) {
  std::vector<std::string> remarks;
  const auto add = [&remarks](std::string remark) {
    if (!remark.empty()) remarks.push_back(std::move(remark));
  };
  add(misfit_remark(noise, fit));
  add(too_good_remark(noise, fit));
  add(outlier_remark(points, fit));
  if (fit.map.jacobian_m_per_px(points.points.front().pixel).determinant() > 0.0) {
    add("the field is mirrored: seen from above, with v down, y must point to the left of x. Are "
        "x_m and y_m "
        "swapped, or has one the wrong sign?");
  }
  if (fit.residuals.points < kComfortablePoints) {
    add(fmt::format("{} points are few; give {} or more, spread to the corners of the field.",
                    fit.residuals.points, kComfortablePoints));
  }
  if (!noise.is_stated()) {
    add("no noise is stated (--pixel-noise, --survey-noise): all of the residual counts as error "
        "of the model, "
        "which is the careful choice.");
  }
  return remarks;
}

}  // namespace nadir::calibration
