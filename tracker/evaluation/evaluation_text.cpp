#include "tracker/evaluation/evaluation_text.h"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

namespace nadir::tracker {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMmPerM = 1000.0;
constexpr double kDegPerRad = 57.295779513082320877;

std::vector<PoseError> all_errors(const Evaluation& evaluation) {
  std::vector<PoseError> all;
  for (const auto& [name, errors] : evaluation.errors) {
    all.insert(all.end(), errors.begin(), errors.end());
  }
  return all;
}

double found_share(const Evaluation& evaluation) {
  return evaluation.true_robots == 0
             ? 0.0
             : static_cast<double>(evaluation.found) / static_cast<double>(evaluation.true_robots);
}

std::string robot_line(const std::string& name, const ErrorStatistics& errors) {
  return fmt::format("{:<12} {:>7} {:>10.3f} {:>10.3f} {:>10.3f} {:>10.3f} {:>8.2f} {:>10.3f}\n",
                     name, errors.count, errors.rms_position_m * kMmPerM,
                     errors.p95_position_m * kMmPerM, errors.rms.z() * kDegPerRad,
                     errors.p95_heading_rad * kDegPerRad, errors.mean_nees, errors.coverage95);
}

std::string error_lines(const ErrorStatistics& all) {
  const Band band = nees_band95(all.count);
  std::string text = fmt::format(
      "per axis      RMS x {:.3f} mm, y {:.3f} mm; bias x {:+.3f} mm, y {:+.3f} mm, heading "
      "{:+.3f} deg\n"
      "in pixels     RMS u {:.4f} px, v {:.4f} px; bias u {:+.4f} px, v {:+.4f} px\n"
      "NEES          mean {:.2f}; 3 is honest, {:.2f} to {:.2f} is the 95 % band of independent "
      "errors\n",
      all.rms.x() * kMmPerM, all.rms.y() * kMmPerM, all.bias.x() * kMmPerM, all.bias.y() * kMmPerM,
      all.bias.z() * kDegPerRad, all.rms_px.x(), all.rms_px.y(), all.bias_px.x(), all.bias_px.y(),
      all.mean_nees, band.low, band.high);
  if (all.singular > 0) {
    text += fmt::format("              {} covariances are not positive definite\n", all.singular);
  }
  return text;
}

Json statistics_json(const ErrorStatistics& errors) {
  const Band band = nees_band95(errors.count);
  return {{"count", errors.count},
          {"rms_position_m", errors.rms_position_m},
          {"p95_position_m", errors.p95_position_m},
          {"rms_x_m", errors.rms.x()},
          {"rms_y_m", errors.rms.y()},
          {"rms_heading_rad", errors.rms.z()},
          {"p95_heading_rad", errors.p95_heading_rad},
          {"bias_x_m", errors.bias.x()},
          {"bias_y_m", errors.bias.y()},
          {"bias_heading_rad", errors.bias.z()},
          {"rms_u_px", errors.rms_px.x()},
          {"rms_v_px", errors.rms_px.y()},
          {"bias_u_px", errors.bias_px.x()},
          {"bias_v_px", errors.bias_px.y()},
          {"mean_nees", errors.mean_nees},
          {"nees_band95", {band.low, band.high}},
          {"coverage95", errors.coverage95},
          {"singular_covariances", errors.singular}};
}

Json reception_json(const Reception& reception) {
  return {{"logged", reception.logged},
          {"received", reception.received},
          {"lost", reception.lost},
          {"latency_p50_us", reception.latency_p50_us},
          {"latency_p99_us", reception.latency_p99_us},
          {"frame_rate_hz", reception.frame_rate_hz}};
}

}  // namespace

StageSummary summarise_stages(const std::vector<LoggedFrame>& poses) {
  std::vector<double> detect_us;
  std::vector<double> total_us;
  for (const LoggedFrame& frame : poses) {
    detect_us.push_back(frame.detect_us);
    total_us.push_back(frame.total_us);
  }
  return {percentile(detect_us, 0.5), percentile(total_us, 0.5), percentile(total_us, 0.99)};
}

std::string evaluation_table(const Evaluation& evaluation, const StageSummary& stages,
                             const std::optional<Reception>& reception) {
  std::string text =
      fmt::format("{:<12} {:>7} {:>10} {:>10} {:>10} {:>10} {:>8} {:>10}\n", "robot", "found",
                  "pos RMS mm", "pos 95% mm", "head RMS d", "head 95% d", "NEES", "within 95%");
  for (const auto& [name, errors] : evaluation.errors) {
    text += robot_line(fmt::format("{} {}", name.first, name.second), summarise(errors));
  }
  const ErrorStatistics all = summarise(all_errors(evaluation));
  text += robot_line("all", all) + error_lines(all);
  text += fmt::format(
      "found         {} of {} ({:.2f} %) in {} frames; wrong name {}, false robots {}\n",
      evaluation.found, evaluation.true_robots, 100.0 * found_share(evaluation), evaluation.frames,
      evaluation.wrong_names, evaluation.false_robots);
  text +=
      fmt::format("time a frame  p50 {:.0f} us, p99 {:.0f} us (of which detection p50 {:.0f} us)\n",
                  stages.total_p50_us, stages.total_p99_us, stages.detect_p50_us);
  if (reception) {
    text += fmt::format(
        "over DDS      {} of {} poses received, {} lost, {:.1f} frames/s; latency p50 {:.0f} us, "
        "p99 {:.0f} us\n",
        reception->received, reception->logged, reception->lost, reception->frame_rate_hz,
        reception->latency_p50_us, reception->latency_p99_us);
  }
  return text;
}

std::string evaluation_json(const Evaluation& evaluation, const StageSummary& stages,
                            const std::optional<Reception>& reception) {
  Json json = {{"frames", evaluation.frames},
               {"frames_without_truth", evaluation.frames_without_truth},
               {"true_robots", evaluation.true_robots},
               {"found", evaluation.found},
               {"found_share", found_share(evaluation)},
               {"wrong_names", evaluation.wrong_names},
               {"false_robots", evaluation.false_robots},
               {"all", statistics_json(summarise(all_errors(evaluation)))}};
  Json robots = Json::array();
  for (const auto& [name, errors] : evaluation.errors) {
    Json robot = {{"team", name.first}, {"id", name.second}};
    robot.update(statistics_json(summarise(errors)));
    robots.push_back(robot);
  }
  json["robots"] = robots;
  json["stages_us"] = {{"detect_p50", stages.detect_p50_us},
                       {"total_p50", stages.total_p50_us},
                       {"total_p99", stages.total_p99_us}};
  if (reception) json["dds"] = reception_json(*reception);
  return json.dump(2) + "\n";
}

}  // namespace nadir::tracker
