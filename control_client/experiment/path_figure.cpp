#include "control_client/experiment/path_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "control_client/experiment/svg_axes.h"

namespace nadir::control_client {
namespace {

// Lengths in the figure's own unit.
constexpr double kPanel = 270.0;
constexpr double kLeft = 62.0;
constexpr double kGap = 68.0;
constexpr double kTop = 66.0;
constexpr double kTimeHeight = 130.0;
constexpr double kBetween = 76.0;  // panels and time axis
constexpr double kBlock = kTop + kPanel + kBetween + kTimeHeight + 48.0;
constexpr std::size_t kMaxPanels = 4;
constexpr std::size_t kMaxBlocks = 6;

constexpr const char* kStyle = R"(<style>
text { font-family: "DejaVu Sans", Verdana, Helvetica, Arial, sans-serif; font-size: 12px; fill: #222; }
.title { font-size: 13px; font-weight: bold; }
.head { font-size: 15px; font-weight: bold; }
.note { font-size: 11px; fill: #555; }
.frame { fill: none; stroke: #444; }
.grid { stroke: #e6e6e6; }
path { fill: none; stroke-linejoin: round; stroke-linecap: round; }
.command { stroke: #c9ced6; stroke-width: 6; }
.estimate { stroke: #111; stroke-width: 1; stroke-dasharray: 5 3; stroke-linecap: butt; }
.true0 { stroke: #1668b5; stroke-width: 1.8; }
.true1 { stroke: #d1493f; stroke-width: 1.8; }
.true2 { stroke: #d98a00; stroke-width: 1.8; }
.true3 { stroke: #3b8f4a; stroke-width: 1.8; }
.used { fill: #6d7b8a; fill-opacity: 0.55; }
.rejected { fill: none; stroke: #a02060; stroke-width: 1.1; }
</style>
)";

/// Runs under the same conditions, one for each driver.
using Block = std::vector<const CaseResult*>;

std::vector<Block> blocks_of(const ExperimentResult& result) {
  std::vector<Block> blocks;
  for (const CaseResult& each : result.cases) {
    const bool is_new = blocks.empty() || blocks.back().front()->label != each.label;
    if (is_new && blocks.size() == kMaxBlocks) break;
    if (is_new) blocks.emplace_back();
    if (blocks.back().size() < kMaxPanels) blocks.back().push_back(&each);
  }
  return blocks;
}

/// A square of the field with all commands in it and some room around, mm.
AxesRange field_of(const Block& block) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
  for (const TickRecord& tick : block.front()->example.ticks) {
    low = low.cwiseMin(1e3 * tick.command.head<2>());
    high = high.cwiseMax(1e3 * tick.command.head<2>());
  }
  const Eigen::Vector2d middle = 0.5 * (low + high);
  const double half = 0.5 * std::max((high - low).maxCoeff(), 100.0) * 1.4;
  return {middle.x() - half, middle.x() + half, middle.y() - half, middle.y() + half};
}

std::string draw_frames(const SvgAxes& axes, const RunRecord& record) {
  std::string out;
  for (const FrameDecision& decision : record.decisions.front()) {
    const Eigen::Vector2d place_mm =
        1e3 * record.frames[decision.number].pose_world_robot.position_m();
    out += axes.dot(place_mm, decision.is_used ? 1.1 : 3.0, decision.is_used ? "used" : "rejected");
  }
  return out;
}

std::string draw_paths(const SvgAxes& axes, const CaseResult& each, std::size_t colour) {
  std::vector<Eigen::Vector2d> command;
  std::vector<Eigen::Vector2d> truth;
  std::vector<Eigen::Vector2d> estimate;
  for (std::size_t i = 0; i < each.example.ticks.size(); ++i) {
    command.emplace_back(1e3 * each.example.ticks[i].command.head<2>());
    truth.emplace_back(1e3 * each.example.ticks[i].truth.head<2>());
    estimate.emplace_back(1e3 * each.example.estimates.front()[i].pose.position_m());
  }
  std::string out = axes.curve(command, "command");
  out += draw_frames(axes, each.example);
  out += axes.curve(truth, fmt::format("true{}", colour));
  const EstimatorKind driver = each.estimators.front();
  // Held frames jump: as a curve they would hide everything; the truth is its own estimate.
  if (driver != EstimatorKind::kTruth && driver != EstimatorKind::kVision) {
    out += axes.curve(estimate, "estimate");
  }
  return out;
}

std::string draw_errors(const SvgAxes& axes, const CaseResult& each, std::size_t colour) {
  std::vector<Eigen::Vector2d> error;
  for (const TickRecord& tick : each.example.ticks) {
    error.emplace_back(tick.time_s, 1e3 * (tick.truth - tick.nominal.pose).head<2>().norm());
  }
  return axes.curve(error, fmt::format("true{}", colour));
}

std::string draw_block(const Block& block, std::size_t index) {
  const double top = kTop + kBlock * static_cast<double>(index);
  std::string out = svg_text(kLeft, top - 36.0, block.front()->label, "class=\"head\"");
  const AxesRange field = field_of(block);
  for (std::size_t i = 0; i < block.size(); ++i) {
    const CaseResult& each = *block[i];
    const double left = kLeft + (kPanel + kGap) * static_cast<double>(i);
    const SvgAxes axes(fmt::format("p{}_{}", index, i), {left, top, kPanel, kPanel}, field);
    out += axes.frame("driven by " + estimator_name(each.estimators.front()), "x, mm", "y, mm");
    out += draw_paths(axes, each, i);
    const RunMetrics run = measure(each.example);
    out += svg_text(left + kPanel, top - 9.0,
                    fmt::format("{:.1f} mm rms", 1e3 * run.to_nominal.position_rms_m),
                    "class=\"note\" text-anchor=\"end\"");
  }
  const double width =
      (kPanel + kGap) * static_cast<double>(std::max<std::size_t>(block.size(), 2)) - kGap;
  const double end_s = block.front()->example.ticks.back().time_s;
  const SvgAxes time(fmt::format("t{}", index),
                     {kLeft, top + kPanel + kBetween, width, kTimeHeight},
                     {0.0, end_s, 0.1, 1000.0, true});
  out += time.frame("distance to the nominal motion", "time, s", "mm");
  for (std::size_t i = block.size(); i-- > 0;) out += draw_errors(time, *block[i], i);
  return out;
}

std::string legend_entry(double& x, double y, const std::string& mark, double mark_width,
                         const std::string& words, double words_width) {
  std::string out = mark + svg_text(x + mark_width + 6.0, y + 4.0, words, "class=\"note\"");
  x += mark_width + words_width + 26.0;
  return out;
}

std::string legend(double y) {
  double x = kLeft;
  const auto stroke = [&](const char* look) {
    return fmt::format("<path d=\"M{:.1f} {:.1f}h26\" class=\"{}\"/>\n", x, y, look);
  };
  const auto ring = [&](double radius, const char* look) {
    return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" class=\"{}\"/>\n", x + 4.0, y,
                       radius, look);
  };
  std::string out = legend_entry(x, y, stroke("command"), 26.0, "commanded", 66.0);
  out += legend_entry(x, y, stroke("true0"), 26.0, "true (each driver its colour)", 154.0);
  out += legend_entry(x, y, stroke("estimate"), 26.0, "estimated", 58.0);
  out += legend_entry(x, y, ring(1.6, "used"), 8.0, "frame used", 64.0);
  out += legend_entry(x, y, ring(3.0, "rejected"), 8.0, "frame rejected", 84.0);
  return out;
}

}  // namespace

std::string path_figure(const ExperimentResult& result) {
  const std::vector<Block> blocks = blocks_of(result);
  std::size_t panels = 2;
  for (const Block& block : blocks) panels = std::max(panels, block.size());
  const double width = kLeft + (kPanel + kGap) * static_cast<double>(panels) - kGap + 24.0;
  const double height = kBlock * static_cast<double>(blocks.size()) + 34.0;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\">\n{2}"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      width, height, kStyle);
  for (std::size_t i = 0; i < blocks.size(); ++i) out += draw_block(blocks[i], i);
  out += legend(height - 18.0);
  return out + "</svg>\n";
}

}  // namespace nadir::control_client
