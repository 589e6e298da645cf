#include "calibration/noise/noise_from_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace nadir::calibration {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

std::string law_yaml(const LawVariance& law) {
  return fmt::format(
      "kind: law\n"
      "pixel_variance_m2: {:.6g}  # per axis and mark: this / pixel count + floor\n"
      "floor_m2: {:.6g}\n"
      "minimum_pixels: {:g}\n",
      law.pixel_variance_m2, law.floor_m2, law.minimum_pixels);
}

std::string table_yaml(const TableVariance& table) {
  std::string text = "kind: table\nclasses:\n";
  for (const TableVariance::Class& each : table.classes) {
    text += fmt::format(
        "  - from_pixels: {:.4g}\n"
        "    variance_x_m2: {:.6g}\n"
        "    variance_y_m2: {:.6g}\n"
        "    variance_heading_rad2: [{:.6g}]\n",
        each.from_pixels, each.x_m2, each.y_m2, fmt::join(each.heading_rad2, ", "));
  }
  return text;
}

}  // namespace

std::string noise_yaml(const NoiseFit& fit, const std::string& origin) {
  const auto* table = std::get_if<TableVariance>(&fit.law);
  std::string floor;
  if (fit.alignment_floor_px) {
    floor = fmt::format("alignment_floor_px: {:.4g}  # for --variance fisher\n",
                        *fit.alignment_floor_px);
  }
  return fmt::format("# nadir-calibrate noise, from {}\nnadir_noise: 1\n{}{}", origin,
                     table != nullptr ? table_yaml(*table) : law_yaml(fit.one_over_n), floor);
}

std::string noise_summary(const StandingData& data, const NoiseFit& fit) {
  std::string text = fmt::format(
      "{} poses of standing robots at {} places, {} of moving ones left out; variances are known "
      "to {:.0f} %\n\n"
      "  pixels   poses   x mm   y mm  heading deg   mark mm  of it grid  variance / law\n",
      data.samples - data.moving_samples, data.spans.size(), data.moving_samples,
      100.0 * fit.relative_error);
  for (const PixelClass& each : fit.classes) {
    text += fmt::format("  {:6.1f} {:7} {:6.3f} {:6.3f} {:12.4f} {:9.3f} {:11.3f} {:15.2f}\n",
                        each.pixels, each.samples, 1e3 * std::sqrt(each.pose_variance.x()),
                        1e3 * std::sqrt(each.pose_variance.y()),
                        kDegrees * std::sqrt(each.pose_variance.z()),
                        1e3 * std::sqrt(each.mark_variance_m2.mean()),
                        1e3 * std::sqrt(each.grid_variance_m2), each.law_ratio);
  }
  text += fmt::format(
      "  (one sigma: of the pose, then of one mark per axis with what the pixel grid adds)\n\n"
      "  law of a mark: {:.3g} m^2 / pixels + {:.3g} m^2\n",
      fit.one_over_n.pixel_variance_m2, fit.one_over_n.floor_m2);
  if (fit.alignment_floor_px) {
    text +=
        fmt::format("  alignment's floor: {:.4f} px per mark and axis\n", *fit.alignment_floor_px);
  }
  if (!fit.remarks.empty()) text += "\n";
  for (const std::string& remark : fit.remarks) text += "note: " + remark + "\n";
  return text;
}

std::string noise_json(const StandingData& data, const NoiseFit& fit) {
  nlohmann::ordered_json json = {{"poses", data.samples},
                                 {"standing", data.samples - data.moving_samples},
                                 {"moving", data.moving_samples},
                                 {"places", data.spans.size()},
                                 {"pixel_variance_m2", fit.one_over_n.pixel_variance_m2},
                                 {"floor_m2", fit.one_over_n.floor_m2},
                                 {"exponent", fit.exponent},
                                 {"relative_error", fit.relative_error}};
  json["classes"] = nlohmann::ordered_json::array();
  for (const PixelClass& each : fit.classes) {
    json["classes"].push_back({{"pixels", each.pixels},
                               {"poses", each.samples},
                               {"variance_x_m2", each.pose_variance.x()},
                               {"variance_y_m2", each.pose_variance.y()},
                               {"variance_heading_rad2", each.pose_variance.z()},
                               {"mark_variance_m2", each.mark_variance_m2.mean()},
                               {"grid_variance_m2", each.grid_variance_m2},
                               {"law_ratio", each.law_ratio}});
  }
  if (fit.alignment_floor_px) json["alignment_floor_px"] = *fit.alignment_floor_px;
  json["remarks"] = fit.remarks;
  return json.dump() + "\n";
}

}  // namespace nadir::calibration
