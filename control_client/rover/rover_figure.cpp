#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "control_client/experiment/svg_axes.h"
#include "control_client/rover/rover_report.h"

namespace nadir::control_client {
namespace {

constexpr double kField = 420.0;
constexpr double kTimes = 520.0;
constexpr double kTop = 60.0;
constexpr double kLeft = 62.0;
constexpr const char* kStyle = R"(.c0 { stroke: #d1493f; }
.c1 { stroke: #d98a00; }
.c2 { stroke: #1668b5; }
.c3 { stroke: #3b8f4a; }
.landmark { fill: #222; }
.way { fill: none; stroke: #a02060; stroke-width: 1.4; }
)";

/// The cases that are drawn, in the order of their colours.
std::vector<const RoverCase*> drawn_cases(const std::vector<RoverCase>& cases) {
  std::vector<const RoverCase*> drawn;
  for (const char* name : {"command", "differences", "eso10", "eso10_tight"}) {
    const auto found = std::find_if(cases.begin(), cases.end(),
                                    [&](const RoverCase& c) { return c.variant.name == name; });
    if (found != cases.end()) drawn.push_back(&*found);
  }
  return drawn;
}

template <class Value>
std::string curves(const SvgAxes& axes, const std::vector<const RoverCase*>& cases, Value value) {
  std::string out;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    std::vector<Eigen::Vector2d> points;
    for (const RoverTick& tick : cases[i]->example.ticks) points.push_back(value(tick));
    out += axes.curve(points, fmt::format("c{}", i));
  }
  return out;
}

std::string draw_field(const RoverWorld& world, const std::vector<const RoverCase*>& cases) {
  const SvgAxes axes("field", {kLeft, kTop, kField, kField}, {0.0, 10.0, 0.0, 10.0});
  std::string out = axes.frame("true paths", "x, m", "y, m");
  out += curves(axes, cases, [](const RoverTick& tick) { return tick.truth.position_m(); });
  for (const Eigen::Vector2d& place : world.landmarks_m) out += axes.dot(place, 3.5, "landmark");
  for (const Eigen::Vector2d& place : world.way_points_m) out += axes.dot(place, 5.0, "way");
  return out;
}

std::string draw_times(const RoverWorld& world, const std::vector<const RoverCase*>& cases) {
  const double left = kLeft + kField + 84.0;
  constexpr double kHeight = 176.0;
  const SvgAxes error("error", {left, kTop, kTimes, kHeight}, {0.0, world.duration_s, 0.0, 40.0});
  std::string out = error.frame("error of the estimated position", "time, s", "mm");
  out += curves(error, cases, [](const RoverTick& tick) {
    return Eigen::Vector2d(tick.time_s,
                           1e3 * (tick.estimate.position_m() - tick.truth.position_m()).norm());
  });
  const SvgAxes heading("heading", {left, kTop + kField - kHeight, kTimes, kHeight},
                        {0.0, world.duration_s, -20.0, 20.0});
  out += heading.frame("true heading, to be kept at 0", "time, s", "degrees");
  out += curves(heading, cases, [](const RoverTick& tick) {
    return Eigen::Vector2d(tick.time_s, tick.truth.heading_rad * 180.0 / std::numbers::pi);
  });
  return out;
}

std::string legend(const std::vector<const RoverCase*>& cases, double y) {
  std::string out;
  double x = kLeft;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    out += fmt::format("<path d=\"M{:.1f} {:.1f}h26\" class=\"c{}\"/>\n", x, y, i);
    out += svg_text(x + 32.0, y + 4.0, cases[i]->variant.label, "class=\"note\"");
    x += 260.0;
  }
  return out + svg_text(kLeft, y + 24.0, "dots: landmarks, rings: way points", "class=\"note\"");
}

}  // namespace

std::string rover_figure(const RoverWorld& world, const std::vector<RoverCase>& cases) {
  const std::vector<const RoverCase*> drawn = drawn_cases(cases);
  constexpr double kWidth = kLeft + kField + 84.0 + kTimes + 24.0;
  constexpr double kHeight = kTop + kField + 100.0;
  return svg_page(
      kWidth, kHeight, kStyle,
      draw_field(world, drawn) + draw_times(world, drawn) + legend(drawn, kHeight - 36.0));
}

}  // namespace nadir::control_client
