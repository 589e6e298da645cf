#include "tests/bench/svg_plot.h"

#include <fmt/format.h>

#include <cmath>

namespace nadir::bench {
namespace {

// Lengths in the figure's own unit.
constexpr double kPlotWidth = 400.0;
constexpr double kPlotHeight = 330.0;
constexpr double kLeft = 68.0;
constexpr double kRight = 16.0;
constexpr double kTop = 40.0;
constexpr double kBottom = 52.0;
constexpr double kPanelWidth = kLeft + kPlotWidth + kRight;
constexpr double kPanelHeight = kTop + kPlotHeight + kBottom;
constexpr double kCaptionLine = 16.0;
constexpr double kMarkRadius = 3.4;

/// From numbers to the figure, for one panel.
class Axes {
 public:
  Axes(const PlotPanel& panel, double left) : panel_(panel), left_(left) {}

  double x(double value) const {
    return left_ +
           kPlotWidth * std::log(value / panel_.x_from) / std::log(panel_.x_to / panel_.x_from);
  }
  double y(double value) const {
    return kTop +
           kPlotHeight * std::log(panel_.y_to / value) / std::log(panel_.y_to / panel_.y_from);
  }
  double left() const { return left_; }
  double right() const { return left_ + kPlotWidth; }
  double bottom() const { return kTop + kPlotHeight; }

 private:
  const PlotPanel& panel_;
  double left_;
};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string text_at(double x, double y, const std::string& text, const std::string& attributes) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, attributes,
                     escaped(text));
}

std::string line(double x1, double y1, double x2, double y2, const char* kind) {
  return fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" class=\"{}\"/>\n", x1, y1, x2,
      y2, kind);
}

std::string decade_label(double x, double y, int exponent) {
  return fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">10<tspan dy=\"-5\" "
      "font-size=\"9\">{}{}</tspan></text>\n",
      x, y, exponent < 0 ? "\u2212" : "", std::abs(exponent));
}

std::string draw_axes(const PlotPanel& panel, const Axes& axes) {
  std::string out;
  for (const double tick : panel.x_ticks) {
    out += line(axes.x(tick), kTop, axes.x(tick), axes.bottom(), "grid");
    out += text_at(axes.x(tick), axes.bottom() + 17.0, fmt::format("{:g}", tick),
                   "text-anchor=\"middle\"");
  }
  const int last = static_cast<int>(std::floor(std::log10(panel.y_to) + 1e-9));
  for (int e = static_cast<int>(std::ceil(std::log10(panel.y_from) - 1e-9)); e <= last; ++e) {
    const double y = axes.y(std::pow(10.0, e));
    out += line(axes.left(), y, axes.right(), y, "grid");
    out += decade_label(axes.left() - 7.0, y + 4.0, e);
  }
  out += fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" class=\"frame\"/>\n",
      axes.left(), kTop, kPlotWidth, kPlotHeight);
  out += text_at(axes.left(), kTop - 14.0, panel.title, "class=\"title\"");
  out += text_at(0.5 * (axes.left() + axes.right()), axes.bottom() + 37.0, panel.x_name,
                 "text-anchor=\"middle\"");
  const double middle = kTop + 0.5 * kPlotHeight;
  out += text_at(axes.left() - 46.0, middle, panel.y_name,
                 fmt::format("text-anchor=\"middle\" transform=\"rotate(-90 {:.1f} {:.1f})\"",
                             axes.left() - 46.0, middle));
  return out;
}

/// Joined points; for steps a piece for every two.
std::string draw_path(const PlotSeries& series, const Axes& axes) {
  std::string path;
  const bool steps = series.kind == PlotSeries::Kind::kSteps;
  for (std::size_t i = 0; i < series.points.size(); ++i) {
    const bool starts = i == 0 || (steps && i % 2 == 0);
    path += fmt::format("{}{:.1f} {:.1f} ", starts ? 'M' : 'L', axes.x(series.points[i].x),
                        axes.y(series.points[i].y));
  }
  return fmt::format("<path d=\"{}\" stroke=\"{}\" class=\"{}\"/>\n", path, series.colour,
                     series.kind == PlotSeries::Kind::kDashes ? "dashes"
                     : steps                                  ? "steps"
                                                              : "curve");
}

std::string draw_marks(const PlotSeries& series, const Axes& axes) {
  std::string out;
  const bool dots = series.kind == PlotSeries::Kind::kDots;
  for (const PlotPoint& point : series.points) {
    out += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\" stroke=\"{}\" "
        "stroke-width=\"1.5\"/>\n",
        axes.x(point.x), axes.y(point.y), kMarkRadius, dots ? series.colour : "white",
        series.colour);
  }
  return out;
}

std::string draw_series(const PlotSeries& series, const Axes& axes) {
  const bool marks =
      series.kind == PlotSeries::Kind::kRings || series.kind == PlotSeries::Kind::kDots;
  return marks ? draw_marks(series, axes) : draw_path(series, axes);
}

std::string draw_labels(const PlotSeries& series, const Axes& axes) {
  std::string out;
  for (const PlotLabel& label : series.labels) {
    out += text_at(
        axes.x(label.at.x), axes.y(label.at.y), label.text,
        fmt::format("text-anchor=\"{}\" fill=\"{}\" class=\"label\"", label.anchor, series.colour));
  }
  return out;
}

constexpr const char* kStyle = R"(<style>
text { font-family: "DejaVu Sans", Verdana, Helvetica, Arial, sans-serif; font-size: 12px; }
.title { font-size: 14px; font-weight: bold; }
.caption { fill: #555555; font-size: 11px; }
.label { paint-order: stroke; stroke: white; stroke-width: 3px; stroke-linejoin: round; }
.frame { fill: none; stroke: #444444; }
.grid { stroke: #e4e4e4; }
.curve { fill: none; stroke-width: 2; }
.dashes { fill: none; stroke-width: 1.5; stroke-dasharray: 6 4; }
.steps { fill: none; stroke-width: 3; }
</style>
)";

}  // namespace

std::string svg_figure(const std::vector<PlotPanel>& panels,
                       const std::vector<std::string>& caption) {
  const double width = kPanelWidth * static_cast<double>(panels.size());
  const double height = kPanelHeight + kCaptionLine * static_cast<double>(caption.size()) + 8.0;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\">\n{2}"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      width, height, kStyle);
  double left = kLeft;
  for (const PlotPanel& panel : panels) {
    const Axes axes(panel, left);
    out += draw_axes(panel, axes);
    for (const PlotSeries& series : panel.series) out += draw_series(series, axes);
    for (const PlotSeries& series : panel.series) out += draw_labels(series, axes);
    left += kPanelWidth;
  }
  double y = kPanelHeight + 8.0;
  for (const std::string& text : caption) {
    out += text_at(kLeft, y, text, "class=\"caption\"");
    y += kCaptionLine;
  }
  return out + "</svg>\n";
}

}  // namespace nadir::bench
