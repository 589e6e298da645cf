#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/fit/map_fit.h"

namespace nadir::calibration {

/// How a model does on points that it has not seen.
struct ModelScore {
  ModelKind model = ModelKind::kPolynomial2;
  /// False where the points, or those of some fold, do not determine the model, or are fewer than
  /// its parameters; all else is then 0 and empty.
  bool is_fitted = false;
  double residual_rms_m = 0.0;         ///< of the fit to all points
  double cross_validated_rms_m = 0.0;  ///< of points that a fold left out
  /// Of the mean square cross-validated error, from its scatter over the blocks, m^2.
  double standard_error_m2 = 0.0;
  std::vector<Eigen::Vector2d> error_m;  ///< of each point when its fold was left out
};

/// Cross-validation in five folds of spatial blocks: the points' box in 5 x 5 to 10 x 10 blocks (of
/// about four points), no two neighbours of one fold. Neighbours of a point that would tell its
/// error in advance are left out with it (Roberts et al., Cross-validation strategies for data with
/// temporal, spatial ... structure, Ecography 40, 2017).
ModelScore cross_validate(ModelKind model, const FieldPoints& points,
                          const FitOptions& options = {});

/// All models, and the one to take.
struct ModelChoice {
  ModelKind model = ModelKind::kPolynomial2;
  std::vector<ModelScore> scores;  ///< in the order of kAllModels
};

/// The simplest model whose mean square error is within one standard error of the best one's
/// (Breiman et al., Classification and Regression Trees, 1984; Hastie, Tibshirani and Friedman, The
/// Elements of Statistical Learning, 2009, section 7.10), so that a polynomial2 that does well is
/// never refused. polynomial2 where nothing can be scored.
ModelChoice choose_model(const FieldPoints& points, const FitOptions& options = {});
/// The same from scores.
ModelKind chosen_model(const std::vector<ModelScore>& scores);

}  // namespace nadir::calibration
