#include "calibration/colours/colours_text.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numbers>

namespace nadir::calibration {
namespace {

using vision::Colour;

constexpr double kDegrees = 180.0 / std::numbers::pi;
/// Pairs nearer than this many sigmas will be confused now and then.
constexpr double kSafeSigmas = 4.0;
constexpr std::size_t kPairsShown = 3;

nlohmann::ordered_json numbers(const vision::Bgr& bgr) { return {bgr[0], bgr[1], bgr[2]}; }

std::string verdict(const ColourMargin& margin) {
  return fmt::format(
      "{} and {} are nearest to confusion: hues {:.0f} degrees apart, their middle "
      "{:.1f} sigma away{}",
      colour_name(margin.a), colour_name(margin.b), kDegrees * margin.hue_rad, margin.sigmas,
      margin.sigmas < kSafeSigmas ? "; too near: use other inks or a whiter light" : "");
}

}  // namespace

std::string colours_yaml(const ColourStudy& study, const vision::ColourClasses& classes,
                         const std::string& origin) {
  std::string text = fmt::format(
      "# nadir-calibrate colours, from {}: blue, green, red; only the hue counts\ncolours:\n",
      origin);
  for (int i = 0; i < vision::kColourCount; ++i) {
    const auto colour = static_cast<Colour>(i);
    if (!has_hue(colour)) continue;  // judged by brightness alone
    const vision::Bgr& typical = classes.of(colour);
    const int samples = study.of(colour).samples;
    text +=
        fmt::format("  {}: [{:.0f}, {:.0f}, {:.0f}]  # {}\n", colour_name(colour), typical[0],
                    typical[1], typical[2],
                    samples > 0 ? fmt::format("{} discs", samples)
                                : std::string("not seen: built in, in the light of the others"));
  }
  return text;
}

std::string colours_summary(const ColourStudy& study, const RobotCounts& counts) {
  std::string text = fmt::format(
      "{} robots in {} images; {} with the built-in colours\n\n"
      "  colour   discs   blue  green    red   hue deg  scatter  chroma\n",
      counts.robots, counts.images, counts.robots_by_default);
  for (int i = 0; i < vision::kColourCount; ++i) {
    const ColourStatistics& seen = study.of(static_cast<Colour>(i));
    if (seen.samples == 0) continue;
    text += fmt::format("  {:<8} {:5} {:6.0f} {:6.0f} {:6.0f} {:9.1f} {:8.1f} {:7.0f}\n",
                        colour_name(static_cast<Colour>(i)), seen.samples, seen.value[0],
                        seen.value[1], seen.value[2], kDegrees * seen.hue_rad,
                        kDegrees * seen.hue_sigma_rad, seen.chroma);
  }
  if (study.margins.empty()) return text;
  text += "\n  pair               hue deg  margin sigma\n";
  for (std::size_t i = 0; i < std::min(kPairsShown, study.margins.size()); ++i) {
    const ColourMargin& margin = study.margins[i];
    text += fmt::format("  {:<8} {:<8} {:8.1f} {:13.1f}\n", colour_name(margin.a),
                        colour_name(margin.b), kDegrees * margin.hue_rad, margin.sigmas);
  }
  return text + "\n" + verdict(study.margins.front()) + "\n";
}

std::string colours_json(const ColourStudy& study, const vision::ColourClasses& classes,
                         const RobotCounts& counts) {
  nlohmann::ordered_json json = {{"images", counts.images},
                                 {"robots", counts.robots},
                                 {"robots_by_default", counts.robots_by_default}};
  json["colours"] = nlohmann::ordered_json::object();
  for (int i = 0; i < vision::kColourCount; ++i) {
    const auto colour = static_cast<Colour>(i);
    const ColourStatistics& seen = study.of(colour);
    if (seen.samples == 0) continue;
    json["colours"][colour_name(colour)] = {
        {"discs", seen.samples},        {"typical", numbers(classes.of(colour))},
        {"value", numbers(seen.value)}, {"difference", numbers(seen.difference)},
        {"hue_rad", seen.hue_rad},      {"hue_sigma_rad", seen.hue_sigma_rad},
        {"chroma", seen.chroma}};
  }
  json["margins"] = nlohmann::ordered_json::array();
  for (const ColourMargin& margin : study.margins) {
    json["margins"].push_back({{"a", colour_name(margin.a)},
                               {"b", colour_name(margin.b)},
                               {"hue_rad", margin.hue_rad},
                               {"sigmas", margin.sigmas}});
  }
  return json.dump() + "\n";
}

}  // namespace nadir::calibration
