#include "calibration/report/report_html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibration/report/report_figures.h"
#include "calibration/report/report_style.h"
#include "calibration/report/report_svg.h"

namespace nadir::calibration {
namespace {

constexpr std::size_t kWorstShown = 8;

const char* grade_class(Grade grade) {
  switch (grade) {
    case Grade::kPass:
      return "pass";
    case Grade::kWarn:
      return "warn";
    case Grade::kFail:
      return "fail";
  }
  return "";
}

/// Three significant digits, never an exponent: lengths of a calibration are 0.0001 to 10,000 mm.
std::string millimetres(double metres) {
  const double mm = 1e3 * metres;
  if (!std::isfinite(mm)) return "\u2013";
  if (mm < 5e-5) return "0";
  const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(std::abs(mm)))), 0, 4);
  return fmt::format("{:.{}f}", mm, decimals);
}

std::string fact(const std::string& value, const std::string& unit, const std::string& name) {
  return fmt::format(
      "<div class=\"fact\"><b>{}</b> <span class=\"unit\">{}</span><span>{}</span></div>\n", value,
      unit, html_escaped(name));
}

std::string noise_text(const StatedNoise& noise) {
  if (!noise.is_stated()) return "no noise stated";
  std::string text = "stated noise";
  if (noise.pixel_px) text += fmt::format(" {:g} px", *noise.pixel_px);
  if (noise.survey_m) {
    text +=
        fmt::format("{} {:g} mm of survey", noise.pixel_px ? " and" : "", 1e3 * *noise.survey_m);
  }
  return text;
}

std::string head(const FieldPoints& points, const FieldResult& result,
                 const ReportNumbers& numbers) {
  const Calibration& calibration = result.calibration;
  const FieldAssessment& assessment = result.assessment;
  std::string text = fmt::format(
      "<header><span class=\"grade {}\">{}</span>\n<div><h1>Calibration from {}</h1>\n<p>{} on {} "
      "points, {:g} m above the field; {}{}</p></div></header>\n",
      grade_class(assessment.grade), grade_name(assessment.grade),
      html_escaped(points.file.empty() ? "points" : points.file),
      model_name(calibration.map.kind()), result.fit.residuals.points, calibration.height_m,
      noise_text(calibration.noise),
      calibration.image_width_px > 0
          ? fmt::format("; images of {} x {} px", calibration.image_width_px,
                        calibration.image_height_px)
          : std::string());
  text += "<section class=\"facts\">\n";
  text += fact(millimetres(result.fit.residuals.rms_m), "mm", "residual, RMS");
  text += fact(fmt::format("{:.3f}", result.fit.residuals.rms_px), "px", "the same in the image");
  text += fact(millimetres(assessment.cross_validated.rms_m), "mm", "cross-validated, RMS");
  text += fact(millimetres(numbers.inside_rms_m), "mm", "own error inside, one sigma");
  text += fact(millimetres(numbers.inside_max_m), "mm", "the same, worst place");
  text += fact(fmt::format("{:.0f}", 100.0 * numbers.hull_share), "%",
               calibration.image_width_px > 0 ? "of the image covered" : "of the points' box");
  return text + "</section>\n";
}

std::string findings(const FieldAssessment& assessment) {
  if (assessment.findings.empty()) {
    return "<p class=\"quiet\">Nothing speaks against this calibration.</p>\n";
  }
  std::string text = "<ul class=\"findings\">\n";
  for (const Finding& finding : assessment.findings) {
    text +=
        fmt::format("<li><span class=\"mark {}\">{}</span> {}</li>\n", grade_class(finding.grade),
                    html_escaped(finding.kind), html_escaped(finding.text));
  }
  return text + "</ul>\n";
}

std::string figure(const std::string& title, const std::string& svg, const std::string& caption) {
  return fmt::format("<figure><h2>{}</h2>\n{}<figcaption>{}</figcaption></figure>\n",
                     html_escaped(title), svg, html_escaped(caption));
}

std::string figures(const FieldPoints& points, const FieldResult& result,
                    const ReportNumbers& numbers) {
  std::string text = "<section class=\"figures\">\n";
  text += figure("Residuals", residual_arrows(points, result, numbers),
                 "From the mapped place to the surveyed one, enlarged. Neighbours that point the "
                 "same way are an error of the model; one that stands out is an error of a point.");
  text += figure("Own error of the calibration", error_map(points, result, numbers),
                 "One sigma per axis: what the points' noise and the model's lack of fit leave of "
                 "a place. The tracker adds it to every pose.");
  text += figure("Directions of the residuals", residual_directions(points, result, numbers),
                 "Colour: direction on the field, red +x, yellow-green +y, cyan \u2212x, violet "
                 "\u2212y. A medley is noise; patches of one colour are an error of the model.");
  text += figure("Difference of two half-data solves", half_difference_map(result, numbers),
                 numbers.halves
                     ? "Two maps, each from every other point. Much more than noise alone explains "
                       "is an error that the points' noise does not tell."
                     : "Too few points: half of them do not determine the model.");
  text += figure("Residuals against the stated noise", residual_histogram(result, numbers),
                 fmt::format("x and y of every point. {:.1f} % lie beyond 2 sigma; a normal "
                             "distribution has 4.6 %.",
                             100.0 * numbers.beyond_two_sigma));
  text += figure("Coverage", coverage_map(points, result, numbers),
                 fmt::format("{} of {} parts of the image have no point.", numbers.empty_cells,
                             numbers.coverage.size()));
  return text + "</section>\n";
}

std::string model_table(const FieldResult& result) {
  if (result.assessment.models.empty()) return "";
  std::string text =
      "<div><h2>Models</h2>\n<table><thead><tr><th>model</th><th>parameters</th><th>residual, "
      "mm</th><th>cross-validated, mm</th><th></th></tr></thead><tbody>\n";
  for (const ModelScore& score : result.assessment.models) {
    const bool is_used = score.model == result.calibration.map.kind();
    text += fmt::format("<tr{}><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                        is_used ? " class=\"used\"" : "", model_name(score.model),
                        parameter_count(score.model),
                        score.is_fitted ? millimetres(score.residual_rms_m) : "\u2013",
                        score.is_fitted ? millimetres(score.cross_validated_rms_m) : "\u2013",
                        is_used           ? "used"
                        : score.is_fitted ? ""
                                          : "not determined by these points");
  }
  return text +
         "</tbody></table>\n<p class=\"quiet\">RMS distance. Cross-validated: on points in "
         "parts of the image that the fit has not seen.</p></div>\n";
}

std::string worst_table(const FieldPoints& points, const FieldResult& result) {
  const auto& residuals = result.fit.point_residuals;
  std::vector<std::size_t> order(residuals.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return residuals[a].distance_m > residuals[b].distance_m;
  });
  order.resize(std::min(kWorstShown, order.size()));
  std::string text =
      "<div><h2>Worst points</h2>\n<table><thead><tr><th>line</th><th>u, px</th><th>v, px</th>"
      "<th>x, m</th><th>y, m</th><th>residual, mm</th><th>px</th><th>left out, mm</th></tr></thead>"
      "<tbody>\n";
  const auto& left_out = result.assessment.leave_one_out_m;
  for (const std::size_t i : order) {
    const FieldPoint& point = points.points[i];
    text += fmt::format(
        "<tr><td>{}</td><td>{:.1f}</td><td>{:.1f}</td><td>{:.3f}</td><td>{:.3f}</td><td>{}</td>"
        "<td>{:.2f}</td><td>{}</td></tr>\n",
        point.line > 0 ? fmt::format("{}", point.line) : std::string("\u2013"), point.pixel.x(),
        point.pixel.y(), point.position_m.x(), point.position_m.y(),
        millimetres(residuals[i].distance_m), residuals[i].distance_px,
        i < left_out.size() ? millimetres(left_out[i].norm()) : std::string("\u2013"));
  }
  return text +
         "</tbody></table>\n<p class=\"quiet\">Left out: distance from the map of all other "
         "points.</p></div>\n";
}

}  // namespace

std::string report_html(const FieldPoints& points, const FieldResult& result,
                        const ReportNumbers& numbers) {
  return fmt::format(
             "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta "
             "name=\"viewport\" content=\"width=device-width\">\n<title>Calibration from "
             "{}</title>\n<style>{}</style></head>\n<body>{}<main>\n",
             html_escaped(points.file), kReportStyle, kReportPatterns) +
         head(points, result, numbers) + findings(result.assessment) +
         figures(points, result, numbers) + "<section class=\"tables\">\n" + model_table(result) +
         worst_table(points, result) + "</section>\n</main></body></html>\n";
}

}  // namespace nadir::calibration
