#include "calibration/survey_file.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <string>

#include "vision/input/csv_table.h"

namespace nadir::calibration {
namespace {

/// Rows within this of the plane's height are on it.
constexpr double kSamePlane_m = 0.0005;

/// Whether the header, the first line that is no remark, names z_m.
bool has_heights(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line)) {
    if (line.find_first_not_of(" \t\r") == std::string::npos || line.front() == '#') continue;
    return line.find("z_m") != std::string::npos;
  }
  return false;
}

}  // namespace

Survey load_survey(const std::filesystem::path& file, double plane_height_m) {
  Survey survey;
  if (!has_heights(file)) {
    survey.plane = load_field_points(file);
    return survey;
  }
  const auto table = vision::CsvTable::load(file, {"u_px", "v_px", "x_m", "y_m", "z_m"});
  survey.plane.file = file.string();
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const FieldPoint point{{table.number(row, 0), table.number(row, 1)},
                           {table.number(row, 2), table.number(row, 3)},
                           table.line(row)};
    const double z_m = table.number(row, 4);
    if (std::abs(z_m - plane_height_m) <= kSamePlane_m) {
      survey.plane.points.push_back(point);
    } else {
      survey.others.push_back({point, z_m});
    }
  }
  if (survey.plane.points.empty()) {
    throw vision::InputError(
        {survey.plane.file},
        fmt::format("holds no points with a z_m of {}, the plane's height", plane_height_m),
        "state the height at which most points are with --height");
  }
  return survey;
}

}  // namespace nadir::calibration
