#include "calibration/diagnosis/robust_reference.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vision/input/input_error.h"

namespace nadir::calibration {
namespace {

/// From the rigid to the flexible: each starts from the weights of the one before.
constexpr std::array<ModelKind, 4> kCandidates = {ModelKind::kPolynomial2, ModelKind::kPolynomial3,
                                                  ModelKind::kRadial2, ModelKind::kPolynomial5};
/// A more flexible model must be this much better.
constexpr double kWorthwhile = 0.8;
/// A flexible model needs so many points a parameter, or it follows the errors of single points.
constexpr double kPointsPerParameter = 2.0;
constexpr int kDistanceSteps = 4;
constexpr int kTukeySteps = 4;
/// Where Tukey's weight reaches zero, in sigma; and the weight that is left there, so that a point
/// that was misjudged may return.
constexpr double kTukeyReach = 8.0;
constexpr double kLeastWeight = 1e-6;
/// Median of a distance in the plane, in sigma per axis: sqrt(2 ln 2).
constexpr double kMedianDistance = 1.1774100225154747;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Per axis; a fit makes its own residuals smaller than the errors.
double sigma(std::vector<double> distances, ModelKind model) {
  const auto count = static_cast<double>(distances.size());
  const double free = std::max(1.0, count - 0.5 * parameter_count(model));
  return median(std::move(distances)) / kMedianDistance * std::sqrt(count / free);
}

std::vector<double> distances_px(const std::vector<PointResidual>& residuals) {
  std::vector<double> distances;
  distances.reserve(residuals.size());
  for (const PointResidual& residual : residuals) distances.push_back(residual.distance_px);
  return distances;
}

std::vector<double> distances_m(const std::vector<PointResidual>& residuals) {
  std::vector<double> distances;
  distances.reserve(residuals.size());
  for (const PointResidual& residual : residuals) distances.push_back(residual.distance_m);
  return distances;
}

/// 1 / distance: the sum of distances, not of squares, is made small.
std::vector<double> distance_weights(const std::vector<PointResidual>& residuals) {
  const std::vector<double> distances = distances_m(residuals);
  const double usual_m = std::max(median(distances), 1e-12);
  std::vector<double> weights;
  weights.reserve(distances.size());
  for (const double distance_m : distances)
    weights.push_back(usual_m / std::max(distance_m, usual_m));
  return weights;
}

std::vector<double> tukey_weights(const std::vector<PointResidual>& residuals, ModelKind model) {
  const std::vector<double> distances = distances_m(residuals);
  const double reach_m = kTukeyReach * std::max(sigma(distances, model), 1e-12);
  std::vector<double> weights;
  weights.reserve(distances.size());
  for (const double distance_m : distances) {
    const double t = std::min(1.0, distance_m / reach_m);
    weights.push_back(std::max(kLeastWeight, std::pow(1.0 - t * t, 2)));
  }
  return weights;
}

std::optional<RobustReference> fitted(ModelKind model, const FieldPoints& points,
                                      FitOptions options) {
  std::optional<RobustReference> reference;
  try {
    for (int step = 0; step < kDistanceSteps + kTukeySteps; ++step) {
      const PlaneMap map = fit_map(model, points, options);
      std::vector<PointResidual> residuals = point_residuals(map, points);
      options.weights =
          step + 1 < kDistanceSteps ? distance_weights(residuals) : tukey_weights(residuals, model);
      const double sigma_m = sigma(distances_m(residuals), model);
      const double sigma_px = sigma(distances_px(residuals), model);
      reference = {map, std::move(residuals), sigma_m, sigma_px};
    }
  } catch (const vision::InputError&) {
    // What could be fitted before remains.
  }
  return reference;
}

}  // namespace

std::optional<RobustReference> robust_reference(const FieldPoints& points,
                                                const FitOptions& options) {
  std::optional<RobustReference> best;
  FitOptions start = options;
  for (const ModelKind model : kCandidates) {
    const bool is_first = model == kCandidates.front();
    if (!is_first &&
        static_cast<double>(points.points.size()) < kPointsPerParameter * parameter_count(model)) {
      continue;
    }
    std::optional<RobustReference> reference = fitted(model, points, start);
    if (!reference) continue;
    const bool is_better = !best || reference->sigma_m * reference->sigma_px <
                                        kWorthwhile * kWorthwhile * best->sigma_m * best->sigma_px;
    if (!is_better) continue;
    best = std::move(reference);
    start.weights = distance_weights(best->residuals);
  }
  return best;
}

}  // namespace nadir::calibration
