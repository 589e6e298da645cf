#include "calibration/diagnosis/assessment.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "calibration/diagnosis/misfit.h"
#include "calibration/diagnosis/point_findings.h"
#include "calibration/diagnosis/set_findings.h"

namespace nadir::calibration {

std::vector<Finding> diagnose_points(const FieldPoints& points, const StatedNoise& noise,
                                     const FitOptions& options) {
  const std::optional<RobustReference> reference = robust_reference(points, options);
  std::vector<Finding> findings = set_findings(points, reference);
  if (!reference) return findings;
  const bool is_mixed_up = std::any_of(findings.begin(), findings.end(),
                                       [](const Finding& one) { return one.kind == "mixed up"; });
  if (is_mixed_up) return findings;
  for (Finding& finding : point_findings(points, *reference, noise)) {
    findings.push_back(std::move(finding));
  }
  return findings;
}

FieldAssessment assess(const FieldPoints& points, const StatedNoise& noise,
                       const FitOptions& options, const FieldFit& fit, const ModelChoice& choice,
                       std::vector<Finding> diagnosis, int width_px, int height_px) {
  const ModelKind model = fit.map.kind();
  FieldAssessment assessment;
  assessment.models = choice.scores;
  assessment.recommended = choice.model;
  assessment.leave_one_out_m = leave_one_out_errors_m(fit_map(model, points, options), points);
  assessment.leave_one_out =
      residual_statistics(residuals_of(assessment.leave_one_out_m, fit.map, points));
  const ModelScore& score = assessment.score(model);
  if (score.is_fitted) {
    assessment.cross_validated = residual_statistics(residuals_of(score.error_m, fit.map, points));
  }
  assessment.lack_of_fit = lack_of_fit_test(fit.map, points, noise);

  assessment.findings = std::move(diagnosis);
  const auto add = [&assessment](std::vector<Finding> findings) {
    for (Finding& finding : findings) assessment.findings.push_back(std::move(finding));
  };
  add(misfit_findings(noise, fit, choice, assessment.lack_of_fit));
  add(coverage_findings(model, points, width_px, height_px));
  std::stable_sort(assessment.findings.begin(), assessment.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.grade > b.grade; });
  assessment.grade = grade_of(assessment.findings);
  return assessment;
}

std::vector<std::size_t> worst_points(const FieldFit& fit, std::size_t count) {
  std::vector<std::size_t> order(fit.point_residuals.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&fit](std::size_t a, std::size_t b) {
    return fit.point_residuals[a].distance_m > fit.point_residuals[b].distance_m;
  });
  order.resize(std::min(count, order.size()));
  return order;
}

}  // namespace nadir::calibration
