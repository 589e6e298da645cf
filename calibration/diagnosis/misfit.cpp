#include "calibration/diagnosis/misfit.h"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace nadir::calibration {
namespace {

/// The model is blamed where chance would leave as much in one of a thousand cases, and it leaves
/// this many times what the noise explains: a noise that is stated a little too small is no misfit.
constexpr double kUnlikely = 1e-3;
constexpr double kMisfitRatio = 1.5;
/// Without stated noise: another model has so much less error in cross-validation, and what is left
/// is more than the usual error of finding a point well.
constexpr double kMuchBetter = 0.6;
constexpr double kWellFound_px = 0.2;
/// Corners are found to well below a pixel; more than this asks for an explanation even where no
/// noise is stated.
constexpr double kUsualResidual_px = 1.0;
/// Below this share of the stated noise, or of a pixel where none is stated, points agree too well
/// to be measured.
constexpr double kTooGoodRatio = 0.3;
constexpr double kTooGood_px = 1e-3;

const ModelScore& score_of(const ModelChoice& choice, ModelKind model) {
  return choice.scores.at(static_cast<std::size_t>(model));
}

/// ", radial leaves 0.5 mm: use --model radial" or why not.
std::string advice(const FieldFit& fit, const ModelChoice& choice) {
  const ModelScore& best = score_of(choice, choice.model);
  const bool helps = choice.model != fit.map.kind() && best.is_fitted &&
                     best.residual_rms_m < kMuchBetter * fit.residuals.rms_m;
  if (!helps) {
    return ". No other model does much better; what is unexplained counts as error of the "
           "positions near by.";
  }
  return fmt::format(
      ", {0} leaves {1:.2g} mm: use --model {0}. Until then what is unexplained counts as error of "
      "the positions near by.",
      model_name(choice.model), 1e3 * best.residual_rms_m);
}

std::optional<Finding> misfit(const StatedNoise& noise, const FieldFit& fit,
                              const ModelChoice& choice, const std::optional<ChiSquareTest>& test) {
  const std::string left =
      fmt::format("{} leaves {:.3g} mm RMS ({:.2g} px)", model_name(fit.map.kind()),
                  1e3 * fit.residuals.rms_m, fit.residuals.rms_px);
  if (noise.is_stated()) {
    const bool is_unlikely = !test || test->p_value < kUnlikely;
    if (!is_unlikely || fit.residuals.rms_m <= kMisfitRatio * fit.explained_rms_m) {
      return std::nullopt;
    }
    return Finding{Grade::kWarn,
                   "misfit",
                   {},
                   fmt::format("the model does not fit: {}, the stated noise explains {:.2g} mm{}",
                               left, 1e3 * fit.explained_rms_m, advice(fit, choice))};
  }
  const ModelScore& own = score_of(choice, fit.map.kind());
  const ModelScore& best = score_of(choice, choice.model);
  const bool is_beaten = own.is_fitted && choice.model != own.model && best.is_fitted &&
                         best.cross_validated_rms_m < kMuchBetter * own.cross_validated_rms_m &&
                         fit.residuals.rms_px > kWellFound_px;
  if (!is_beaten && fit.residuals.rms_px <= kUsualResidual_px) return std::nullopt;
  return Finding{Grade::kWarn,
                 "misfit",
                 {},
                 fmt::format("the model probably does not fit: {}{}{}", left,
                             is_beaten ? "" : ", more than the usual error of finding a point",
                             advice(fit, choice))};
}

/// Residuals say nothing of the calibration's error where points were computed or the noise is
/// overstated.
std::optional<Finding> too_good(const StatedNoise& noise, const FieldFit& fit) {
  if (2 * fit.residuals.points <= parameter_count(fit.map.kind())) {
    return Finding{Grade::kPass,
                   "too good",
                   {},
                   fmt::format("{} points always fit {}: their residual says nothing about the "
                               "error.",
                               fit.residuals.points, model_name(fit.map.kind()))};
  }
  const bool is_below_noise =
      noise.is_stated() && fit.residuals.rms_m < kTooGoodRatio * fit.explained_rms_m;
  if (!is_below_noise && fit.residuals.rms_px >= kTooGood_px) return std::nullopt;
  return Finding{Grade::kPass,
                 "too good",
                 {},
                 fmt::format("the points agree to {:.2g} px, better than they can be measured{}: "
                             "were they computed? The calibration's own error is then not known "
                             "from them.",
                             fit.residuals.rms_px, is_below_noise ? " by the stated noise" : "")};
}

}  // namespace

std::vector<Finding> misfit_findings(const StatedNoise& noise, const FieldFit& fit,
                                     const ModelChoice& choice,
                                     const std::optional<ChiSquareTest>& test) {
  std::vector<Finding> findings;
  const auto add = [&findings](std::optional<Finding> finding) {
    if (finding) findings.push_back(std::move(*finding));
  };
  add(misfit(noise, fit, choice, test));
  add(too_good(noise, fit));
  if (!noise.is_stated()) {
    findings.push_back({Grade::kPass,
                        "no noise stated",
                        {},
                        "no noise is stated (--pixel-noise, --survey-noise): all of the residual "
                        "counts as error of the model, which is the careful choice."});
  }
  return findings;
}

}  // namespace nadir::calibration
