// Reading of NOISE.yaml: which law gives a disc's variance from its pixel count, and with which
// constants.

#include "calibration/noise_file.h"

#include <string>

#include "vision/input/strict_yaml.h"

namespace nadir::calibration {
namespace {

using vision::YamlMap;

constexpr const char* kVersionKey = "nadir_noise";
constexpr const char* kFloorKey = "alignment_floor_px";
constexpr int kNoiseVersion = 1;
constexpr vision::ValidRange kPixels{1.0, 1e6};
constexpr vision::ValidRange kVariance_m2{1e-15, 1.0};
constexpr vision::ValidRange kVariance_rad2{1e-12, 10.0};

TableVariance read_table(const YamlMap& file) {
  TableVariance table;
  const std::vector<YamlMap> rows = file.maps("classes");
  if (rows.empty()) throw file.error("classes", "'classes' is empty", "write one class at least");
  for (const YamlMap& row : rows) {
    TableVariance::Class each;
    each.from_pixels = row.number("from_pixels", kPixels);
    if (!table.classes.empty() && each.from_pixels <= table.classes.back().from_pixels) {
      throw row.error("from_pixels", "'from_pixels' does not rise from class to class",
                      "order the classes by it");
    }
    each.x_m2 = row.number("variance_x_m2", kVariance_m2);
    each.y_m2 = row.number("variance_y_m2", kVariance_m2);
    each.heading_rad2 = row.numbers("variance_heading_rad2", rows.size(), kVariance_rad2);
    row.finish();
    table.classes.push_back(std::move(each));
  }
  return table;
}

LawVariance read_law(const YamlMap& file) {
  LawVariance law;
  law.pixel_variance_m2 = file.number_or("pixel_variance_m2", law.pixel_variance_m2, kVariance_m2);
  law.floor_m2 = file.number_or("floor_m2", law.floor_m2, {0.0, kVariance_m2.high});
  law.minimum_pixels = file.number_or("minimum_pixels", law.minimum_pixels, kPixels);
  return law;
}

DropOutVariance read_drop_out(const YamlMap& file) {
  DropOutVariance law;
  law.floor_px = file.number_or("floor_px", law.floor_px, {0.0, 10.0});
  law.complete_share = file.number_or("complete_share", law.complete_share, {0.01, 1.0});
  law.minimum_pixels = file.number_or("minimum_pixels", law.minimum_pixels, kPixels);
  return law;
}

PixelCountVariance::Law read_kind(const YamlMap& file) {
  const std::string kind = file.choice("kind", {"table", "law", "pixels"});
  if (kind == "table") return read_table(file);
  if (kind == "law") return read_law(file);
  return read_drop_out(file);
}

}  // namespace

NoiseFile load_noise_file(const std::filesystem::path& path) {
  const YamlMap file = YamlMap::load(path);
  const int version = file.integer(kVersionKey);
  if (version != kNoiseVersion) {
    throw file.error(kVersionKey,
                     "noise file of version " + std::to_string(version) +
                         "; this nadir reads version " + std::to_string(kNoiseVersion),
                     "see the formats in calibration/README.md");
  }
  NoiseFile noise;
  noise.variance = PixelCountVariance(read_kind(file));
  constexpr vision::ValidRange kFloor_px{0.0, 10.0};
  if (file.has(kFloorKey)) noise.alignment_floor_px = file.number(kFloorKey, kFloor_px);
  file.finish();
  return noise;
}

PixelCountVariance load_pixel_count_variance(const std::filesystem::path& path) {
  return load_noise_file(path).variance;
}

}  // namespace nadir::calibration
