#include "calibration/report/report_json.h"

#include <nlohmann/json.hpp>

namespace nadir::calibration {
namespace {

using Json = nlohmann::ordered_json;

Json own_error(const ReportNumbers& numbers) {
  Json map = Json::array();
  for (const FieldCell& cell : numbers.field) {
    if (!cell.is_seen) continue;
    map.push_back({cell.place_m.x(), cell.place_m.y(), cell.sigma_m, cell.is_extrapolated});
  }
  return {{"inside_rms_m", numbers.inside_rms_m},
          {"inside_max_m", numbers.inside_max_m},
          {"outside_max_m", numbers.outside_max_m},
          {"map_columns", {"x_m", "y_m", "sigma_m", "extrapolated"}},
          {"map", map}};
}

Json half_data(const ReportNumbers& numbers) {
  if (!numbers.halves) return nullptr;
  return {{"rms_m", numbers.halves->rms_m},
          {"max_m", numbers.halves->max_m},
          {"expected_rms_m", numbers.halves->expected_rms_m}};
}

Json coverage(const ReportNumbers& numbers) {
  Json cells = Json::array();
  for (const CoverageCell& cell : numbers.coverage) cells.push_back(cell.points);
  return {{"hull_share", numbers.hull_share},
          {"empty_cells", numbers.empty_cells},
          {"points_per_cell", cells}};
}

}  // namespace

std::string with_report_numbers(const std::string& field_json, const ReportNumbers& numbers) {
  Json json = Json::parse(field_json);
  json["own_error"] = own_error(numbers);
  json["half_data"] = half_data(numbers);
  json["coverage"] = coverage(numbers);
  json["histogram"] = {{"beyond_two_sigma", numbers.beyond_two_sigma},
                       {"normalised_residuals", numbers.normalised_residuals}};
  return json.dump() + "\n";
}

}  // namespace nadir::calibration
