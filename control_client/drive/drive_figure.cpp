#include "control_client/drive/drive_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "control_client/drive/drive_errors.h"
#include "control_client/experiment/svg_axes.h"

namespace nadir::control_client {
namespace {

// Lengths in the figure's own unit.
constexpr double kPanel = 280.0;
constexpr double kLeft = 66.0;
constexpr double kGap = 70.0;
constexpr double kTop = 40.0;
constexpr double kTimeTop = kTop + kPanel + 66.0;
constexpr double kTimeHeight = 130.0;
constexpr double kLegend = kTimeTop + kTimeHeight + 62.0;
constexpr double kTable = kLegend + 44.0;
constexpr double kRow = 21.0;
constexpr std::size_t kMaxDrives = 4;
constexpr double kDegrees = 180.0 / std::numbers::pi;

constexpr const char* kStyle = R"(<style>
text { font-family: "DejaVu Sans", Verdana, Helvetica, Arial, sans-serif; font-size: 12px; fill: #222; }
.title { font-size: 13px; font-weight: bold; }
.head { font-weight: bold; }
.frame { fill: none; stroke: #444; }
.grid { stroke: #e8e8e8; }
.rule { stroke: #444; }
path { fill: none; stroke-linejoin: round; stroke-linecap: round; }
.command { stroke: #cfd5de; stroke-width: 7; }
.encoders { stroke: #d1493f; stroke-width: 1.4; }
.true { stroke: #1668b5; stroke-width: 2.2; }
.estimate { stroke: #111; stroke-width: 1; stroke-dasharray: 4 3; stroke-linecap: butt; }
.fused { stroke: #111; stroke-width: 1; }
</style>
)";

using Points = std::vector<Eigen::Vector2d>;

/// Ticks that become one point: a figure needs no more than a few hundred.
std::size_t ticks_a_point(const DriveRecord& drive) {
  constexpr std::size_t kPoints = 500;
  return drive.rows.size() / kPoints + 1;
}

Points path_mm(const DriveRecord& drive, fusion::PlanarPose DriveRow::*pose) {
  const std::size_t step = ticks_a_point(drive);
  Points points;
  for (std::size_t i = 0; i < drive.rows.size(); i += step) {
    points.emplace_back(1e3 * (drive.rows[i].*pose).position_m());
  }
  return points;
}

/// The largest distance from the truth among the ticks of a point: no peak is lost.
Points distance_mm(const DriveRecord& drive, fusion::PlanarPose DriveRow::*pose) {
  constexpr double kSmallest_mm = 0.05;  // of the axis: a zero has no logarithm
  const std::size_t step = ticks_a_point(drive);
  Points points;
  for (std::size_t i = 0; i < drive.rows.size(); ++i) {
    const DriveRow& row = drive.rows[i];
    const double distance = 1e3 * ((row.*pose).position_m() - row.truth.position_m()).norm();
    if (i % step == 0) points.emplace_back(row.time_s, kSmallest_mm);
    points.back().y() = std::max(points.back().y(), distance);
  }
  return points;
}

/// A square of the field with everything commanded and true in it, mm.
AxesRange field_of(const DriveRecord& drive) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
  for (const auto pose : {&DriveRow::command, &DriveRow::truth, &DriveRow::encoders}) {
    for (const Eigen::Vector2d& point : path_mm(drive, pose)) {
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    }
  }
  const Eigen::Vector2d middle = 0.5 * (low + high);
  const double half = 0.55 * std::max((high - low).maxCoeff(), 100.0);
  return {middle.x() - half, middle.x() + half, middle.y() - half, middle.y() + half};
}

std::string draw(const DriveRecord& drive, std::size_t column) {
  const double left = kLeft + static_cast<double>(column) * (kPanel + kGap);
  const SvgAxes field(fmt::format("field{}", column), {left, kTop, kPanel, kPanel},
                      field_of(drive));
  std::string out = field.frame(drive.name, "x, mm", "y, mm");
  out += field.curve(path_mm(drive, &DriveRow::command), "command");
  out += field.curve(path_mm(drive, &DriveRow::encoders), "encoders");
  out += field.curve(path_mm(drive, &DriveRow::truth), "true");
  out += field.curve(path_mm(drive, &DriveRow::estimate), "estimate");
  const SvgAxes time(fmt::format("time{}", column), {left, kTimeTop, kPanel, kTimeHeight},
                     {0.0, std::max(1.0, drive.rows.back().time_s), 0.05, 500.0, true});
  out += time.frame("", "time, s", "error, mm");
  out += time.curve(distance_mm(drive, &DriveRow::encoders), "encoders");
  return out + time.curve(distance_mm(drive, &DriveRow::estimate), "fused");
}

std::string legend(double y) {
  struct Entry {
    const char* look;
    const char* text;
    double width;
  };
  std::string out;
  double x = kLeft;
  for (const Entry& entry : {Entry{"command", "commanded", 80.0}, Entry{"true", "true", 40.0},
                             Entry{"estimate", "estimated by fusion", 134.0},
                             Entry{"encoders", "encoders alone", 0.0}}) {
    out += fmt::format("<path d=\"M{:.1f} {:.1f}h28\" class=\"{}\"/>\n", x, y, entry.look);
    out += svg_text(x + 36.0, y + 4.0, entry.text, "");
    x += 36.0 + entry.width + 30.0;
  }
  return out;
}

std::string table(const std::vector<DriveRecord>& drives, double width) {
  constexpr double kColumns[] = {0.0, 290.0, 420.0, 550.0, 690.0};
  std::string out;
  const auto row = [&](double y, const std::vector<std::string>& cells, const char* look) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const double x = kLeft + (i == 0 ? 0.0 : kColumns[i]);
      out += svg_text(x, y, cells[i],
                      fmt::format("class=\"{}\"{}", look, i == 0 ? "" : " text-anchor=\"end\""));
    }
  };
  row(kTable,
      {"root mean square", "fusion, mm", "heading, deg", "encoders, mm", "off the path, mm"},
      "head");
  out += fmt::format(
      "<line x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{:.1f}\" y2=\"{:.1f}\" class=\"rule\"/>\n", kLeft,
      std::min(kLeft + 695.0, width - 10.0), kTable + 7.0, kTable + 7.0);
  double y = kTable;
  for (const DriveRecord& drive : drives) {
    y += kRow;
    const DriveErrors errors = measure_drive(drive);
    row(y + 3.0,
        {drive.name, fmt::format("{:.2f}", 1e3 * errors.fused.position_rms_m),
         fmt::format("{:.2f}", kDegrees * errors.fused.heading_rms_rad),
         fmt::format("{:.1f}", 1e3 * errors.encoders.position_rms_m),
         fmt::format("{:.2f}", 1e3 * errors.tracking.position_rms_m)},
        "");
  }
  return out;
}

}  // namespace

std::string drive_figure(const std::vector<DriveRecord>& all) {
  const std::vector<DriveRecord> drives(
      all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), kMaxDrives)));
  const double panels = static_cast<double>(std::max<std::size_t>(drives.size(), 2));
  const double width = kLeft + panels * (kPanel + kGap) - kGap + 24.0;
  const double height = kTable + kRow * static_cast<double>(drives.size()) + 24.0;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\">\n{2}"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      width, height, kStyle);
  for (std::size_t i = 0; i < drives.size(); ++i) out += draw(drives[i], i);
  out += legend(kLegend);
  out += table(drives, width);
  return out + "</svg>\n";
}

}  // namespace nadir::control_client
