#include "control_client/experiment/experiment_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>

namespace nadir::control_client {
namespace {

double mm(double metres) { return 1e3 * metres; }
double deg(double radians) { return radians * 180.0 / std::numbers::pi; }

std::size_t label_width(const ExperimentResult& result) {
  std::size_t width = 9;
  for (const CaseResult& each : result.cases) width = std::max(width, each.label.size());
  return width;
}

/// How well the robot drove.
void put_driving(std::string& text, const ExperimentResult& result) {
  const std::size_t width = label_width(result);
  const auto out = std::back_inserter(text);
  constexpr const char* kHead =
      "{:<{}} {:<19} {:>8} {:>6} {:>8} {:>7} {:>8} {:>8} {:>6} {:>7} {:>7}\n";
  fmt::format_to(out, kHead, "driving", width, "by", "nominal", "", "command", "path", "largest",
                 "diverged", "sat.", "demand", "settled");
  fmt::format_to(out, kHead, "", width, "", "mm", "deg", "mm", "mm", "mm", "", "%", "V", "s");
  for (const CaseResult& each : result.cases) {
    const RunMetrics& mean = each.summary.mean;
    fmt::format_to(
        out,
        "{:<{}} {:<19} {:>8.2f} {:>6.2f} {:>8.2f} {:>7.2f} {:>8.1f} {:>8} {:>6.1f} {:>7.1f} "
        "{:>7.2f}\n",
        each.label, width, estimator_name(each.estimators.front()),
        mm(mean.to_nominal.position_rms_m), deg(mean.to_nominal.heading_rms_rad),
        mm(mean.to_command.position_rms_m), mm(mean.path_rms_m), mm(mean.to_nominal_max_m),
        fmt::format("{}/{}", each.summary.diverged, each.summary.runs), 100.0 * mean.saturated,
        mean.peak_demand_v, mean.settled_s);
  }
}

void put_errors(std::string& text, std::size_t width, const std::string& label,
                const std::string& name, const PoseErrors& errors) {
  fmt::format_to(std::back_inserter(text), "{:<{}} {:<19} {:>7.2f} {:>6.2f}", label, width, name,
                 mm(errors.position_rms_m), deg(errors.heading_rms_rad));
}

void put_estimate(std::string& text, const EstimateMetrics& estimate) {
  const auto out = std::back_inserter(text);
  fmt::format_to(out, " {:>8.1f}", mm(estimate.error.position_max_m));
  if (estimate.nees > 0.0) {
    fmt::format_to(out, " {:>7.2f} {:>6.2f} {:>10} {:>9.2f}", estimate.nees, estimate.nis,
                   fmt::format("{}/{}", estimate.outliers_accepted, estimate.outliers),
                   100.0 * estimate.inliers_rejected / std::max(1, estimate.inliers));
  }
  text += '\n';
}

/// How well the robot knew where it was.
void put_estimation(std::string& text, const ExperimentResult& result) {
  const std::size_t width = label_width(result);
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "\n{:<{}} {:<19} {:>7} {:>6} {:>8} {:>7} {:>6} {:>10} {:>9}\n", "estimating",
                 width, "", "mm", "deg", "largest", "NEES", "NIS", "outl. acc.", "rej. %");
  for (const CaseResult& each : result.cases) {
    for (std::size_t i = 0; i < each.estimators.size(); ++i) {
      const EstimateMetrics& estimate = each.summary.mean.estimates[i];
      put_errors(text, width, each.label, estimator_name(each.estimators[i]), estimate.error);
      put_estimate(text, estimate);
    }
    if (!each.bounds) continue;
    put_errors(text, width, each.label, "bound, delayed", each.bounds->delayed);
    text += '\n';
    put_errors(text, width, each.label, "bound, no delay", each.bounds->zero_delay);
    text += '\n';
    put_errors(text, width, each.label, "bound, smoothing", each.bounds->smoothing);
    text += '\n';
  }
}

nlohmann::json json_errors(const PoseErrors& errors) {
  return {{"position_rms_m", errors.position_rms_m},
          {"heading_rms_rad", errors.heading_rms_rad},
          {"position_max_m", errors.position_max_m}};
}

nlohmann::json json_estimate(EstimatorKind kind, const EstimateMetrics& estimate) {
  nlohmann::json json = json_errors(estimate.error);
  json["estimator"] = estimator_name(kind);
  if (estimate.nees <= 0.0) return json;
  json["nees"] = estimate.nees;
  json["nis"] = estimate.nis;
  json["accepted"] = estimate.accepted;
  json["outliers"] = estimate.outliers;
  json["outliers_accepted"] = estimate.outliers_accepted;
  json["inliers"] = estimate.inliers;
  json["inliers_rejected"] = estimate.inliers_rejected;
  return json;
}

nlohmann::json json_case(const CaseResult& each) {
  const RunMetrics& mean = each.summary.mean;
  nlohmann::json estimates = nlohmann::json::array();
  for (std::size_t i = 0; i < each.estimators.size(); ++i) {
    estimates.push_back(json_estimate(each.estimators[i], mean.estimates[i]));
  }
  nlohmann::json json = {{"label", each.label},
                         {"driver", estimator_name(each.estimators.front())},
                         {"to_nominal", json_errors(mean.to_nominal)},
                         {"to_command", json_errors(mean.to_command)},
                         {"path_rms_m", mean.path_rms_m},
                         {"to_nominal_max_m", mean.to_nominal_max_m},
                         {"overshoot_x_m", mean.overshoot_x_m},
                         {"settled_s", mean.settled_s},
                         {"saturated", mean.saturated},
                         {"peak_demand_v", mean.peak_demand_v},
                         {"diverged", each.summary.diverged},
                         {"estimates", estimates}};
  if (each.bounds) {
    json["bounds"] = {{"delayed", json_errors(each.bounds->delayed)},
                      {"zero_delay", json_errors(each.bounds->zero_delay)},
                      {"smoothing", json_errors(each.bounds->smoothing)}};
  }
  return json;
}

}  // namespace

std::string text_report(const ExperimentResult& result) {
  std::string text = fmt::format("{}: {} run{}, seeds from {}\n", result.name, result.runs,
                                 result.runs == 1 ? "" : "s", result.first_seed);
  put_driving(text, result);
  put_estimation(text, result);
  return text;
}

nlohmann::json json_report(const ExperimentResult& result) {
  nlohmann::json cases = nlohmann::json::array();
  for (const CaseResult& each : result.cases) cases.push_back(json_case(each));
  return {{"experiment", result.name},
          {"runs", result.runs},
          {"first_seed", result.first_seed},
          {"cases", cases}};
}

}  // namespace nadir::control_client
