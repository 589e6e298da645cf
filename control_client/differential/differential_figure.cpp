#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "control_client/differential/differential_report.h"
#include "control_client/experiment/svg_axes.h"

namespace nadir::control_client {
namespace {

constexpr double kField = 420.0;
constexpr double kTimes = 520.0;
constexpr double kTop = 60.0;
constexpr double kLeft = 62.0;
constexpr double kGap = 84.0;
constexpr std::size_t kMostDrawn = 4;
constexpr std::size_t kDrawnTick = 5;  // one of so many
constexpr const char* kStyle = R"(.reference { stroke: #999; stroke-width: 4; opacity: 0.5; }
.c0 { stroke: #1668b5; }
.c1 { stroke: #3b8f4a; }
.c2 { stroke: #d1493f; }
.c3 { stroke: #d98a00; }
)";

using Results = std::vector<const DifferentialResult*>;

Results drawn_results(const std::vector<DifferentialResult>& results,
                      const DifferentialLook& look) {
  Results drawn;
  for (const std::string& name : look.drawn) {
    const auto found = std::find_if(results.begin(), results.end(), [&](const auto& each) {
      return each.which.name == name && !each.example.empty();
    });
    if (found != results.end() && drawn.size() < kMostDrawn) drawn.push_back(&*found);
  }
  return drawn;
}

// A square that holds the reference, with a margin: who drives away leaves the picture.
AxesRange field_range(const Results& drawn) {
  Eigen::Array2d low = Eigen::Array2d::Constant(1e9);
  Eigen::Array2d high = -low;
  for (const DifferentialTick& tick : drawn.front()->example) {
    low = low.min(tick.reference.pose.position_m().array());
    high = high.max(tick.reference.pose.position_m().array());
  }
  const Eigen::Array2d middle = 0.5 * (low + high);
  const double half = 0.68 * (high - low).maxCoeff();
  return {middle.x() - half, middle.x() + half, middle.y() - half, middle.y() + half};
}

// A value of some of a run's ticks.
template <class Value>
std::vector<Eigen::Vector2d> points_of(const DifferentialResult& result, Value value) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < result.example.size(); i += kDrawnTick) {
    points.push_back(value(result.example[i]));
  }
  return points;
}

std::string draw_field(const Results& drawn) {
  const SvgAxes axes("field", {kLeft, kTop, kField, kField}, field_range(drawn));
  std::string out = axes.frame("true paths on the reference (grey)", "x, m", "y, m");
  out +=
      axes.curve(points_of(*drawn.front(),
                           [](const DifferentialTick& t) { return t.reference.pose.position_m(); }),
                 "reference");
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    out += axes.curve(
        points_of(*drawn[i], [](const DifferentialTick& t) { return t.truth.position_m(); }),
        fmt::format("c{}", i));
  }
  return out;
}

std::string draw_errors(const Results& drawn) {
  constexpr double kMillimetres = 1e3;
  double most_mm = 10.0;
  std::vector<std::vector<Eigen::Vector2d>> curves;
  for (const DifferentialResult* each : drawn) {
    curves.push_back(points_of(*each, [&](const DifferentialTick& t) {
      const double off_m = (t.truth.position_m() - t.reference.pose.position_m()).norm();
      most_mm = std::max(most_mm, kMillimetres * off_m);
      return Eigen::Vector2d(t.time_s, kMillimetres * off_m);
    }));
  }
  const double end_s = drawn.front()->example.back().time_s;
  AxesRange range{0.0, end_s, 0.0, 1.05 * most_mm};
  // Millimetres beside metres need a logarithmic axis.
  if (most_mm > 300.0) range = {0.0, end_s, 1.0, 1.5 * most_mm, true};
  const SvgAxes axes("error", {kLeft + kField + kGap, kTop, kTimes, kField}, range);
  std::string out = axes.frame("distance from the reference", "time, s", "mm");
  for (std::size_t i = 0; i < curves.size(); ++i)
    out += axes.curve(curves[i], fmt::format("c{}", i));
  return out;
}

std::string legend(const Results& drawn, double y) {
  constexpr double kColumn = 264.0;
  std::string out;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const double x = kLeft + kColumn * static_cast<double>(i);
    out += fmt::format("<path d=\"M{:.1f} {:.1f}h26\" class=\"c{}\"/>\n", x, y, i);
    out += svg_text(x + 32.0, y + 4.0, drawn[i]->which.label, "class=\"note\"");
  }
  return out;
}

}  // namespace

std::string differential_figure(const std::vector<DifferentialResult>& results,
                                const DifferentialLook& look) {
  const Results drawn = drawn_results(results, look);
  constexpr double kWidth = kLeft + kField + kGap + kTimes + 24.0;
  constexpr double kHeight = kTop + kField + 84.0;
  if (drawn.empty()) return svg_page(kWidth, kHeight, kStyle, "");
  return svg_page(kWidth, kHeight, kStyle,
                  draw_field(drawn) + draw_errors(drawn) + legend(drawn, kHeight - 20.0));
}

}  // namespace nadir::control_client
