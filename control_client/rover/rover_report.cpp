#include "control_client/rover/rover_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

namespace nadir::control_client {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

std::string text_row(const RoverCase& each) {
  const RoverSummary& s = each.summary;
  std::string out = fmt::format("{:<38}", each.variant.label);
  if (s.diverged == s.runs) {
    return out +
           fmt::format(" diverges {} of {}, after {:.1f} s\n", s.diverged, s.runs, s.diverged_s);
  }
  out += fmt::format(" {:>7.2f} {:>6.1f} {:>7.2f} {:>6.3f} {:>7.1f} {:>6.3f} {:>6.1f} {:>7.1f}",
                     s.iae_xy_m, 1e3 * s.mae_xy_m, s.iae_heading_rad, kDegrees * s.mae_heading_rad,
                     1e3 * s.position_rms_m, kDegrees * s.heading_rms_rad,
                     kDegrees * s.heading_deviation_rad, 1e3 * s.landmark_rms_m);
  out += s.tours_done > 0 ? fmt::format(" {:>6.1f}", s.tour_done_s) : std::string("  never");
  out += fmt::format(" {:>6.2f} {:>5.0f} {:>6.2f}", s.nees, 1e2 * s.nees_in_band, s.nis);
  if (s.diverged > 0) out += fmt::format("  ({} of {} diverged)", s.diverged, s.runs);
  return out + "\n";
}

nlohmann::json json_case(const RoverCase& each) {
  const RoverSummary& s = each.summary;
  nlohmann::json out = {{"name", each.variant.name},
                        {"label", each.variant.label},
                        {"runs", s.runs},
                        {"diverged", s.diverged}};
  if (s.diverged > 0) out["diverged_s"] = s.diverged_s;
  if (s.diverged == s.runs) return out;
  out.update({{"iae_xy_m", s.iae_xy_m},
              {"mae_xy_m", s.mae_xy_m},
              {"iae_heading_rad", s.iae_heading_rad},
              {"mae_heading_rad", s.mae_heading_rad},
              {"position_rms_m", s.position_rms_m},
              {"heading_rms_rad", s.heading_rms_rad},
              {"heading_deviation_rad", s.heading_deviation_rad},
              {"landmark_rms_m", s.landmark_rms_m},
              {"tours_done", s.tours_done},
              {"nees", s.nees},
              {"nees_in_band", s.nees_in_band},
              {"nis", s.nis}});
  if (s.tours_done > 0) out["tour_done_s"] = s.tour_done_s;
  return out;
}

/// Each set of gains once.
std::string stability_text(const std::vector<RoverCase>& cases) {
  std::string out;
  std::vector<double> seen;
  for (const RoverCase& each : cases) {
    const NavigatorSettings& settings = each.variant.settings;
    if (settings.velocity.kind != VelocityKind::kObserver) continue;
    const auto& gains = settings.velocity.observer;
    const double key = gains[0].velocity_per_s2 + 1e-3 * gains[0].disturbance_n_per_m_per_s;
    if (std::find(seen.begin(), seen.end(), key) != seen.end()) continue;
    seen.push_back(key);
    out += fmt::format("{}\n    x, y:    {}\n    heading: {}\n", each.variant.label,
                       fusion::observer_stability(gains[0], settings.rover.mass_kg).text(),
                       fusion::observer_stability(gains[2], settings.rover.inertia_kgm2).text());
  }
  return out;
}

}  // namespace

std::string rover_text(const std::vector<RoverCase>& cases) {
  std::string out = fmt::format(
      "{:<38} {:>7} {:>6} {:>7} {:>6} {:>7} {:>6} {:>6} {:>7} {:>6} {:>6} {:>5} {:>6}\n", "",
      "IAE xy", "MAE xy", "IAE hd", "MAE hd", "pose", "pose", "turned", "marks", "tour", "NEES",
      "in", "NIS");
  out += fmt::format(
      "{:<38} {:>7} {:>6} {:>7} {:>6} {:>7} {:>6} {:>6} {:>7} {:>6} {:>6} {:>5} {:>6}\n", "", "m",
      "mm", "rad", "deg", "mm rms", "deg", "deg", "mm rms", "s", "(3)", "band%", "(2)");
  for (const RoverCase& each : cases) out += text_row(each);
  return out + "\n" + stability_text(cases);
}

std::string rover_json(const std::vector<RoverCase>& cases, std::uint64_t first_seed) {
  nlohmann::json list = nlohmann::json::array();
  for (const RoverCase& each : cases) list.push_back(json_case(each));
  return nlohmann::json{{"experiment", "e11"}, {"first_seed", first_seed}, {"cases", list}}.dump(
             2) +
         "\n";
}

}  // namespace nadir::control_client
