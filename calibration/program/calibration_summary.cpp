#include "calibration/program/calibration_summary.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <nlohmann/json.hpp>

namespace nadir::calibration {
namespace {

constexpr std::size_t kWorstShown = 3;

/// Mean of both axes.
double variance_m2(const PlaneMap& map, const vision::PixelPoint& pixel) {
  return map.calibration_covariance_m2(pixel).trace() / 2.0;
}

/// RMS over the box of the points: at a single place the error may happen to pass through zero.
double typical_sigma_m(const PlaneMap& map, const PixelBox& box) {
  constexpr int kSteps = 20;
  double sum_m2 = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const Eigen::Vector2d share((i + 0.5) / kSteps, (j + 0.5) / kSteps);
      sum_m2 += variance_m2(map, box.low_px + share.cwiseProduct(box.high_px - box.low_px));
    }
  }
  return std::sqrt(sum_m2 / (kSteps * kSteps));
}

/// Residuals of the points that were fitted, and of points that the fit had not seen.
std::string model_table(const FieldResult& result) {
  const FieldAssessment& assessment = result.assessment;
  std::string text = "  models        fitted  cross-validated  (RMS, mm)\n";
  for (const ModelScore& score : assessment.models) {
    if (!score.is_fitted) continue;
    text += fmt::format("  {:<12}{:8.3f}  {:15.3f}{}{}\n", model_name(score.model),
                        1e3 * score.residual_rms_m, 1e3 * score.cross_validated_rms_m,
                        score.model == result.fit.map.kind() ? "  fitted here" : "",
                        score.model == assessment.recommended ? "  recommended" : "");
  }
  return text;
}

std::string camera_text(const Calibration& calibration) {
  if (!calibration.camera) return "  camera          place unknown: no other marker height\n";
  const CameraPlace& camera = *calibration.camera;
  return fmt::format(
      "  camera          {:.3f} m (+- {:.3f}) above ({:.3f}, {:.3f}) m (+- {:.3f})\n",
      camera.height_m, std::sqrt(camera.height_variance_m2), camera.nadir_m.x(), camera.nadir_m.y(),
      std::sqrt(camera.nadir_covariance_m2.trace() / 2.0));
}

std::string residual_table(const ResidualStatistics& residuals) {
  return fmt::format(
      "  residual        mm       px\n"
      "  RMS     {:10.3f} {:8.3f}\n"
      "  95 %    {:10.3f} {:8.3f}\n"
      "  worst   {:10.3f} {:8.3f}\n",
      1e3 * residuals.rms_m, residuals.rms_px, 1e3 * residuals.p95_m, residuals.p95_px,
      1e3 * residuals.max_m, residuals.max_px);
}

std::string worst_table(const FieldPoints& points, const FieldFit& fit) {
  std::string text = "  worst points  u px     v px       mm       px\n";
  for (const std::size_t index : worst_points(fit, kWorstShown)) {
    const FieldPoint& point = points.points[index];
    const PointResidual& residual = fit.point_residuals[index];
    text +=
        fmt::format("  line {:<5} {:8.1f} {:8.1f} {:8.3f} {:8.3f}\n", point.line, point.pixel.x(),
                    point.pixel.y(), 1e3 * residual.distance_m, residual.distance_px);
  }
  return text;
}

std::string noise_text(const StatedNoise& noise) {
  if (!noise.is_stated()) return "none";
  std::string text;
  if (noise.pixel_px) text += fmt::format("{} px in the image", *noise.pixel_px);
  if (noise.survey_m) {
    text += fmt::format("{}{} mm on the field", text.empty() ? "" : ", ", 1e3 * *noise.survey_m);
  }
  return text;
}

/// What the calibration itself adds to the error of a place: in the box of the points as a rule,
/// and in its worst corner.
std::string error_text(const Calibration& calibration) {
  const PixelBox& box = calibration.points_box;
  const vision::PixelPoint middle = 0.5 * (box.low_px + box.high_px);
  double corner_m2 = 0.0;
  for (const double u : {box.low_px.x(), box.high_px.x()}) {
    for (const double v : {box.low_px.y(), box.high_px.y()}) {
      corner_m2 = std::max(corner_m2, variance_m2(calibration.map, {u, v}));
    }
  }
  const double scale = std::sqrt(std::abs(calibration.map.jacobian_m_per_px(middle).determinant()));
  return fmt::format(
      "  scale           {:.3f} mm/px in the middle of the points\n"
      "  stated noise    {}\n"
      "  own error       {:.3f} mm RMS, {:.3f} mm in the worst corner (one sigma per axis)\n",
      1e3 * scale, noise_text(calibration.noise), 1e3 * typical_sigma_m(calibration.map, box),
      1e3 * std::sqrt(corner_m2));
}

nlohmann::ordered_json residuals_json(const ResidualStatistics& residuals) {
  return {{"points", residuals.points},
          {"rms_m", residuals.rms_m},
          {"p95_m", residuals.p95_m},
          {"max_m", residuals.max_m}};
}

}  // namespace

std::string field_summary(const FieldPoints& points, const FieldResult& result) {
  const FieldAssessment& assessment = result.assessment;
  std::string text = fmt::format(
      "{}: {} on {} points of {}, plane {} m above the field\n\n{}\n{}\n{}\n{}{}",
      grade_name(assessment.grade), model_name(result.fit.map.kind()), result.fit.residuals.points,
      points.file, result.calibration.height_m, residual_table(result.fit.residuals),
      model_table(result), worst_table(points, result.fit), error_text(result.calibration),
      camera_text(result.calibration));
  if (!assessment.findings.empty()) text += "\n";
  for (const Finding& finding : assessment.findings) {
    text +=
        fmt::format("{}: {}\n", finding.grade == Grade::kPass ? "note" : grade_name(finding.grade),
                    finding.text);
  }
  return text;
}

std::string field_json(const FieldPoints& points, const FieldResult& result) {
  using Json = nlohmann::ordered_json;
  const FieldFit& fit = result.fit;
  const FieldAssessment& assessment = result.assessment;
  Json json = residuals_json(fit.residuals);
  json["rms_px"] = fit.residuals.rms_px;
  json["p95_px"] = fit.residuals.p95_px;
  json["max_px"] = fit.residuals.max_px;
  json["model"] = model_name(fit.map.kind());
  json["grade"] = grade_name(assessment.grade);
  json["height_m"] = result.calibration.height_m;
  json["explained_rms_m"] =
      result.calibration.noise.is_stated() ? Json(fit.explained_rms_m) : Json(nullptr);
  json["leave_one_out_rms_m"] = assessment.leave_one_out.rms_m;
  json["cross_validated_rms_m"] = assessment.cross_validated.points > 0
                                      ? Json(assessment.cross_validated.rms_m)
                                      : Json(nullptr);
  json["lack_of_fit"] = nullptr;
  if (assessment.lack_of_fit) {
    json["lack_of_fit"] = {{"chi_square", assessment.lack_of_fit->chi_square},
                           {"degrees_of_freedom", assessment.lack_of_fit->degrees_of_freedom},
                           {"p_value", assessment.lack_of_fit->p_value}};
  }
  json["recommended_model"] = model_name(assessment.recommended);
  json["models"] = Json::array();
  for (const ModelScore& score : assessment.models) {
    if (!score.is_fitted) continue;
    json["models"].push_back({{"model", model_name(score.model)},
                              {"rms_m", score.residual_rms_m},
                              {"cross_validated_rms_m", score.cross_validated_rms_m}});
  }
  json["worst"] = Json::array();
  for (const std::size_t index : worst_points(fit, kWorstShown)) {
    const PointResidual& residual = fit.point_residuals[index];
    json["worst"].push_back({{"line", points.points[index].line},
                             {"error_m", residual.distance_m},
                             {"error_px", residual.distance_px}});
  }
  json["findings"] = Json::array();
  json["remarks"] = Json::array();
  for (const Finding& finding : assessment.findings) {
    json["findings"].push_back({{"grade", grade_name(finding.grade)},
                                {"kind", finding.kind},
                                {"lines", finding.lines},
                                {"text", finding.text}});
    json["remarks"].push_back(finding.text);
  }
  return json.dump() + "\n";
}

std::string validation_summary(const Validation& validation) {
  return fmt::format("{} points\n\n{}\n  inside the predicted 95 % ellipse: {:.1f} %\n",
                     validation.residuals.points, residual_table(validation.residuals),
                     100.0 * validation.coverage95);
}

std::string validation_json(const Validation& validation) {
  nlohmann::ordered_json json = residuals_json(validation.residuals);
  json["coverage95"] = validation.coverage95;
  return json.dump() + "\n";
}

}  // namespace nadir::calibration
