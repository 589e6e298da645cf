#pragma once

#include <optional>
#include <vector>

#include "calibration/diagnosis/finding.h"
#include "calibration/fit/cross_validation.h"
#include "calibration/fit/fit.h"
#include "calibration/fit/leave_one_out.h"

namespace nadir::calibration {

/// What is to be thought of a fit, for people and reports.
struct FieldAssessment {
  Grade grade = Grade::kPass;
  std::vector<Finding> findings;  ///< the gravest first
  /// Every model on these points, in the order of kAllModels.
  std::vector<ModelScore> models;
  ModelKind recommended = ModelKind::kPolynomial2;  ///< what `auto` takes
  std::vector<Eigen::Vector2d> leave_one_out_m;     ///< of each point, surveyed minus mapped
  ResidualStatistics leave_one_out{};
  /// Of the fitted model; without points where it could not be cross-validated.
  ResidualStatistics cross_validated{};
  std::optional<ChiSquareTest> lack_of_fit;  ///< with stated noise

  /// The score of a model.
  const ModelScore& score(ModelKind model) const {
    return models.at(static_cast<std::size_t>(model));
  }
};

/// What is wrong with the points, whatever model is fitted: set_findings and point_findings.
std::vector<Finding> diagnose_points(const FieldPoints& points, const StatedNoise& noise,
                                     const FitOptions& options);

/// Judges `fit` of `points`. `choice` holds the scores of all models, `diagnosis` what
/// diagnose_points said. Image size 0: unknown.
FieldAssessment assess(const FieldPoints& points, const StatedNoise& noise,
                       const FitOptions& options, const FieldFit& fit, const ModelChoice& choice,
                       std::vector<Finding> diagnosis, int width_px, int height_px);

/// Indices of the points with the largest residuals, the worst first.
std::vector<std::size_t> worst_points(const FieldFit& fit, std::size_t count);

}  // namespace nadir::calibration
