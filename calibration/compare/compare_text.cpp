#include "calibration/compare/compare_text.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace nadir::calibration {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr int kShownEvery = 3;  // of the grid's columns and rows

/// Millimetres, some of the places.
std::string number_map(const MapComparison& comparison) {
  std::string text = "  difference in mm over the image (u to the right, v down)\n      u px";
  const auto at = [&](int column, int row) -> const PixelDifference& {
    return comparison
        .differences[static_cast<std::size_t>(row) * static_cast<std::size_t>(comparison.columns) +
                     static_cast<std::size_t>(column)];
  };
  for (int column = 1; column < comparison.columns; column += kShownEvery) {
    text += fmt::format("{:8.0f}", at(column, 0).pixel.x());
  }
  for (int row = 1; row < comparison.rows; row += kShownEvery) {
    text += fmt::format("\n  v {:6.0f}", at(0, row).pixel.y());
    for (int column = 1; column < comparison.columns; column += kShownEvery) {
      text += fmt::format("{:8.2f}", 1e3 * at(column, row).difference_m.norm());
    }
  }
  return text + "\n";
}

std::string verdict(const MapComparison& comparison) {
  if (!comparison.is_significant) {
    return fmt::format("They agree: their own errors explain {:.3f} mm.\n",
                       1e3 * comparison.expected_rms_m);
  }
  const PlaneMotion& motion = comparison.motion;
  return fmt::format(
      "They differ: their own errors explain {:.3f} mm only. Was the camera knocked, or moved?\n"
      "As a motion of the field: {:+.2f} mm in x, {:+.2f} mm in y, turned by {:+.4f} degrees, "
      "larger by {:+.4f} %; {:.3f} mm are left.\n",
      1e3 * comparison.expected_rms_m, 1e3 * motion.shift_m.x(), 1e3 * motion.shift_m.y(),
      kDegrees * motion.turn_rad, 100.0 * (motion.scale - 1.0), 1e3 * motion.rest_rms_m);
}

}  // namespace

std::string comparison_summary(const MapComparison& comparison) {
  const PixelDifference& worst = comparison.worst;
  return fmt::format(
             "  difference      mm       px\n"
             "  RMS     {:10.3f} {:8.3f}\n"
             "  95 %    {:10.3f}\n"
             "  worst   {:10.3f} {:8.3f}   at u {:.0f}, v {:.0f} px, x {:.3f}, y {:.3f} m\n\n",
             1e3 * comparison.rms_m, comparison.rms_px, 1e3 * comparison.p95_m,
             1e3 * worst.difference_m.norm(), worst.difference_px, worst.pixel.x(), worst.pixel.y(),
             worst.place_m.x(), worst.place_m.y()) +
         number_map(comparison) + "\n" + verdict(comparison);
}

std::string comparison_json(const MapComparison& comparison) {
  const PlaneMotion& motion = comparison.motion;
  nlohmann::ordered_json json = {{"points", comparison.differences.size()},
                                 {"rms_m", comparison.rms_m},
                                 {"p95_m", comparison.p95_m},
                                 {"max_m", comparison.worst.difference_m.norm()},
                                 {"rms_px", comparison.rms_px},
                                 {"worst",
                                  {{"u_px", comparison.worst.pixel.x()},
                                   {"v_px", comparison.worst.pixel.y()},
                                   {"x_m", comparison.worst.place_m.x()},
                                   {"y_m", comparison.worst.place_m.y()}}},
                                 {"expected_rms_m", comparison.expected_rms_m},
                                 {"significant", comparison.is_significant},
                                 {"motion",
                                  {{"shift_x_m", motion.shift_m.x()},
                                   {"shift_y_m", motion.shift_m.y()},
                                   {"turn_rad", motion.turn_rad},
                                   {"scale", motion.scale},
                                   {"rest_rms_m", motion.rest_rms_m}}}};
  json["map"] = nlohmann::ordered_json::array();
  for (const PixelDifference& each : comparison.differences) {
    json["map"].push_back(
        {each.pixel.x(), each.pixel.y(), each.difference_m.x(), each.difference_m.y()});
  }
  return json.dump() + "\n";
}

}  // namespace nadir::calibration
