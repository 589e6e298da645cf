#include "control_client/differential/differential_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numbers>

namespace nadir::control_client {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kMillimetres = 1e3;

}  // namespace

std::string differential_text(const std::vector<DifferentialResult>& results,
                              const DifferentialLook& look) {
  std::string out =
      fmt::format("{:<44} {:>8} {:>8} {:>8} {:>10} {:>10}\n", "", "position", "largest", "at end",
                  "heading", look.shows_overshoot ? "overshoot" : "|e2| end");
  out += fmt::format("{:<44} {:>8} {:>8} {:>8} {:>10} {:>10}\n", "", "mm rms", "mm", "mm",
                     "deg rms", "mm");
  for (const DifferentialResult& each : results) {
    const DifferentialSummary& s = each.summary;
    out += fmt::format("{:<44} {:>8.1f} {:>8.1f} {:>8.1f} {:>10.2f} {:>10.1f}\n", each.which.label,
                       kMillimetres * s.position_rms_m, kMillimetres * s.position_max_m,
                       kMillimetres * s.position_end_m, kDegrees * s.heading_rms_rad,
                       kMillimetres * (look.shows_overshoot ? s.overshoot_m : s.side_end_m));
  }
  return out;
}

std::string differential_json(const std::string& experiment,
                              const std::vector<DifferentialResult>& results,
                              std::uint64_t first_seed) {
  nlohmann::json list = nlohmann::json::array();
  for (const DifferentialResult& each : results) {
    const DifferentialSummary& s = each.summary;
    nlohmann::json one = {{"name", each.which.name},
                          {"label", each.which.label},
                          {"runs", s.runs},
                          {"position_rms_m", s.position_rms_m},
                          {"position_max_m", s.position_max_m},
                          {"position_end_m", s.position_end_m},
                          {"side_end_m", s.side_end_m},
                          {"heading_rms_rad", s.heading_rms_rad}};
    if (each.which.corner_m > 0.0) one["overshoot_m"] = s.overshoot_m;
    if (each.which.scenario.kick.turn_rad != 0.0) one["settled_s"] = s.settled_s;
    list.push_back(one);
  }
  const nlohmann::json all = {
      {"experiment", experiment}, {"first_seed", first_seed}, {"cases", list}};
  return all.dump(2) + "\n";
}

}  // namespace nadir::control_client
