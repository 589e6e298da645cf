#include "calibration/field_calibration.h"

#include <algorithm>
#include <string>
#include <utility>

#include "vision/input/input_error.h"

namespace nadir::calibration {
namespace {

std::string refusal(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    if (finding.grade == Grade::kFail) text += (text.empty() ? "" : " ") + finding.text;
  }
  return text;
}

FieldFit fit_or_refuse(ModelKind model, const FieldPoints& points, const StatedNoise& noise,
                       const FitOptions& options, const std::vector<Finding>& diagnosis) {
  try {
    return fit_field(model, points, noise, options);
  } catch (const vision::InputError&) {
    if (grade_of(diagnosis) == Grade::kFail) throw CalibrationRefused(diagnosis);
    throw;
  }
}

/// The best scored of the pinhole models: a polynomial has no camera, but its points do.
ModelKind pinhole_model(const ModelChoice& choice) {
  const ModelScore* best = nullptr;
  for (const ModelScore& score : choice.scores) {
    if (!score.is_fitted || polynomial_order(score.model) > 0) continue;
    if (!best || score.cross_validated_rms_m < best->cross_validated_rms_m) best = &score;
  }
  return best ? best->model : ModelKind::kHomography;
}

std::optional<CameraPlace> camera_place(const FieldPoints& points, const FieldSettings& settings,
                                        const FitOptions& options, const FieldFit& fit,
                                        const ModelChoice& choice) {
  const CameraClues& clues = settings.camera;
  if (clues.height_m && clues.nadir_m) {
    const double variance_m2 = kGivenCameraSigma_m * kGivenCameraSigma_m;
    return CameraPlace{*clues.nadir_m, *clues.height_m, variance_m2 * Eigen::Matrix2d::Identity(),
                       variance_m2, CameraPlace::Source::kGiven};
  }
  if (!clues.other_heights.empty()) {
    return camera_from_heights(fit.map, settings.height_m, clues.other_heights, settings.noise);
  }
  if (!clues.focal_px) return std::nullopt;
  const bool is_pinhole = polynomial_order(fit.map.kind()) == 0;
  const PlaneMap map =
      is_pinhole ? fit.map : fit_field(pinhole_model(choice), points, settings.noise, options).map;
  return camera_from_focal(map, *clues.focal_px, settings.height_m);
}

}  // namespace

CalibrationRefused::CalibrationRefused(std::vector<Finding> findings)
    : std::runtime_error(refusal(findings)), findings_(std::move(findings)) {}

FitOptions fit_options(int image_width_px, int image_height_px) {
  if (image_width_px < 1) return {};
  return {vision::PixelPoint(0.5 * (image_width_px - 1), 0.5 * (image_height_px - 1)), {}};
}

FieldResult calibrate_field(const FieldPoints& points, const FieldSettings& settings) {
  const FitOptions options = fit_options(settings.image_width_px, settings.image_height_px);
  std::vector<Finding> diagnosis = diagnose_points(points, settings.noise, options);
  const ModelChoice choice = choose_model(points, options);
  const ModelKind model = settings.model.value_or(choice.model);
  FieldFit fit = fit_or_refuse(model, points, settings.noise, options, diagnosis);
  FieldAssessment assessment =
      assess(points, settings.noise, options, fit, choice, std::move(diagnosis),
             settings.image_width_px, settings.image_height_px);
  Calibration calibration{.map = fit.map,
                          .height_m = settings.height_m,
                          .image_width_px = settings.image_width_px,
                          .image_height_px = settings.image_height_px,
                          .points_box = pixel_box(points),
                          .residuals = fit.residuals,
                          .noise = settings.noise,
                          .camera = camera_place(points, settings, options, fit, choice)};
  return {std::move(calibration), std::move(fit), std::move(assessment)};
}

}  // namespace nadir::calibration
