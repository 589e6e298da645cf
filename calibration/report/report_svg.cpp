#include "calibration/report/report_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace nadir::calibration {
namespace {

// Margins around the plot, CSS pixels.
constexpr double kLeft = 62.0;
constexpr double kRight = 86.0;  // room for the colour key, also without one: figures line up
constexpr double kTop = 26.0;
constexpr double kBottom = 46.0;
constexpr double kKeyGap = 12.0;
constexpr double kKeyWidth = 14.0;
constexpr double kHead = 3.2;  // of an arrow
constexpr int kTicks = 7;
constexpr int kKeySteps = 48;

// Anchors of the heat scale, dark to light.
struct Rgb {
  double r, g, b;
};
constexpr std::array<Rgb, 6> kHeat = {
    {{48, 25, 95}, {56, 82, 139}, {36, 131, 142}, {57, 176, 115}, {158, 212, 68}, {250, 229, 60}}};

double tick_step(double low, double high, int wanted) {
  const double raw = std::abs(high - low) / std::max(1, wanted);
  if (!(raw > 0.0) || !std::isfinite(raw)) return 1.0;
  const double decade = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= raw) return factor * decade;
  }
  return 10.0 * decade;
}

}  // namespace

std::vector<double> round_ticks(double low, double high, int wanted) {
  const double step = tick_step(low, high, wanted);
  const double first = std::ceil(std::min(low, high) / step - 1e-9);
  const double last = std::floor(std::max(low, high) / step + 1e-9);
  std::vector<double> ticks;
  for (double i = first; i <= last && ticks.size() < 100; i += 1.0) ticks.push_back(i * step);
  return ticks;
}

std::string tick_text(double value, double step) {
  const int decimals =
      std::clamp(static_cast<int>(std::ceil(-std::log10(std::abs(step)) - 1e-9)), 0, 9);
  if (std::abs(value) < 1e-6 * std::abs(step)) value = 0.0;  // no "-0"
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.front() == '-') text.replace(0, 1, "\u2212");
  return text;
}

std::string html_escaped(std::string_view text) {
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
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string heat_colour(double share) {
  const double place =
      std::clamp(std::isfinite(share) ? share : 1.0, 0.0, 1.0) * (kHeat.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(place), kHeat.size() - 2);
  const double t = place - static_cast<double>(low);
  const Rgb& a = kHeat[low];
  const Rgb& b = kHeat[low + 1];
  return fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(std::lround(a.r + t * (b.r - a.r))),
                     static_cast<int>(std::lround(a.g + t * (b.g - a.g))),
                     static_cast<int>(std::lround(a.b + t * (b.b - a.b))));
}

std::string direction_colour(double angle_rad) {
  double degrees = angle_rad * 180.0 / std::numbers::pi;
  if (degrees < 0.0) degrees += 360.0;
  return fmt::format("hsl({:.0f},72%,48%)", degrees);
}

PlotFigure::PlotFigure(PlotAxis x, PlotAxis y, double width, double plot_height, bool equal_scale)
    : x_axis_(std::move(x)),
      y_axis_(std::move(y)),
      left_(kLeft),
      right_(width - kRight),
      top_(kTop),
      bottom_(kTop + plot_height),
      width_(width) {
  if (!equal_scale) return;
  const double height = scale_x() * std::abs(y_axis_.high - y_axis_.low);
  bottom_ = top_ + std::clamp(height, 80.0, 1.5 * width);
}

double PlotFigure::x(double value) const {
  return left_ + (right_ - left_) * (value - x_axis_.low) / (x_axis_.high - x_axis_.low);
}

double PlotFigure::y(double value) const {
  return bottom_ - (bottom_ - top_) * (value - y_axis_.low) / (y_axis_.high - y_axis_.low);
}

double PlotFigure::scale_x() const {
  return (right_ - left_) / std::abs(x_axis_.high - x_axis_.low);
}

void PlotFigure::cell(double x_low, double y_low, double x_high, double y_high,
                      const std::string& fill) {
  const double left = std::min(x(x_low), x(x_high));
  const double top = std::min(y(y_low), y(y_high));
  // A little wider than it is, or hair lines of paper shine through.
  marks_ += fmt::format(
      "<rect class=\"cell\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
      "fill=\"{}\"/>\n",
      left, top, std::abs(x(x_high) - x(x_low)) + 0.35, std::abs(y(y_high) - y(y_low)) + 0.35,
      fill);
}

void PlotFigure::dot(double at_x, double at_y, double radius, const std::string& fill) {
  marks_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"{}\"/>\n", x(at_x),
                        y(at_y), radius, fill);
}

void PlotFigure::ring(double at_x, double at_y, double radius, const char* css_class) {
  marks_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" class=\"{}\"/>\n",
                        x(at_x), y(at_y), radius, css_class);
}

void PlotFigure::arrow(double at_x, double at_y, double dx, double dy, const char* css_class) {
  const double from_x = x(at_x);
  const double from_y = y(at_y);
  const double to_x = x(at_x + dx);
  const double to_y = y(at_y + dy);
  const double length = std::hypot(to_x - from_x, to_y - from_y);
  marks_ += fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}", css_class, from_x,
                        from_y, to_x, to_y);
  if (length > 2.0) {
    const double head = std::min(kHead, 0.45 * length);
    const double ux = (to_x - from_x) / length;
    const double uy = (to_y - from_y) / length;
    for (const double side : {-1.0, 1.0}) {
      marks_ +=
          fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", to_x, to_y,
                      to_x - head * (1.6 * ux + side * uy), to_y - head * (1.6 * uy - side * ux));
    }
  }
  marks_ += "\"/>\n";
}

void PlotFigure::polygon(const std::vector<std::pair<double, double>>& corners,
                         const char* css_class) {
  marks_ += fmt::format("<polygon class=\"{}\" points=\"", css_class);
  for (const auto& [at_x, at_y] : corners)
    marks_ += fmt::format("{:.1f},{:.1f} ", x(at_x), y(at_y));
  marks_ += "\"/>\n";
}

void PlotFigure::curve(const std::vector<std::pair<double, double>>& points,
                       const char* css_class) {
  marks_ += fmt::format("<polyline class=\"{}\" points=\"", css_class);
  for (const auto& [at_x, at_y] : points) marks_ += fmt::format("{:.1f},{:.1f} ", x(at_x), y(at_y));
  marks_ += "\"/>\n";
}

void PlotFigure::label(double at_x, double at_y, double offset_x, double offset_y,
                       const std::string& text, const char* anchor) {
  marks_ +=
      fmt::format("<text class=\"label\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n",
                  x(at_x) + offset_x, y(at_y) + offset_y, anchor, html_escaped(text));
}

void PlotFigure::note(const std::string& text) {
  margin_ +=
      fmt::format("<text class=\"quiet\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
                  right_, top_ - 9.0, html_escaped(text));
}

void PlotFigure::length_key(double length, const std::string& text) {
  const double y_at = top_ - 13.0;
  margin_ += fmt::format(
      "<path class=\"arrow\" d=\"M{0:.1f} {2:.1f}L{1:.1f} {2:.1f}M{1:.1f} {2:.1f}l-5 -3M{1:.1f} "
      "{2:.1f}l-5 3\"/>\n<text class=\"quiet\" x=\"{3:.1f}\" y=\"{4:.1f}\">{5}</text>\n",
      left_, left_ + length, y_at, left_ + length + 7.0, y_at + 4.0, html_escaped(text));
}

void PlotFigure::direction_key() {
  constexpr int kWedges = 36;
  constexpr double kRadius = 20.0;
  const double middle_x = right_ + 0.5 * kRight;
  const double middle_y = top_ + kRadius + 18.0;
  const auto rim = [&](int wedge) {
    const double angle = 2.0 * std::numbers::pi * (wedge - 0.5) / kWedges;
    return fmt::format("{:.1f} {:.1f}", middle_x + kRadius * std::cos(angle),
                       middle_y - kRadius * std::sin(angle));
  };
  for (int wedge = 0; wedge < kWedges; ++wedge) {
    margin_ += fmt::format("<path fill=\"{}\" d=\"M{:.1f} {:.1f}L{}L{}Z\"/>\n",
                           direction_colour(2.0 * std::numbers::pi * wedge / kWedges), middle_x,
                           middle_y, rim(wedge), rim(wedge + 1));
  }
  const auto name = [&](double dx, double dy, const char* text) {
    margin_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                           middle_x + dx, middle_y + dy, text);
  };
  name(kRadius + 10.0, 4.0, "+x");
  name(0.0, -kRadius - 6.0, "+y");
}

void PlotFigure::colour_key(double low, double high, const std::string& name) {
  const double key_x = right_ + kKeyGap;
  for (int i = 0; i < kKeySteps; ++i) {
    const double step = (bottom_ - top_) / kKeySteps;
    margin_ += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.2f}\" width=\"{:.0f}\" height=\"{:.2f}\" fill=\"{}\"/>\n", key_x,
        bottom_ - (i + 1) * step, kKeyWidth, step + 0.35, heat_colour((i + 0.5) / kKeySteps));
  }
  const double step = tick_step(low, high, 5);
  for (const double tick : round_ticks(low, high, 5)) {
    const double y_at = bottom_ - (bottom_ - top_) * (tick - low) / (high - low);
    margin_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", key_x + kKeyWidth + 4.0,
                           y_at + 4.0, tick_text(tick, step));
  }
  margin_ += fmt::format("<text class=\"quiet\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", key_x,
                         top_ - 9.0, html_escaped(name));
}

void PlotFigure::draw_axes(std::string& out) const {
  const double x_step = tick_step(x_axis_.low, x_axis_.high, kTicks);
  for (const double tick : round_ticks(x_axis_.low, x_axis_.high, kTicks)) {
    out += fmt::format(
        "<line class=\"grid\" x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\"/>\n"
        "<text x=\"{0:.1f}\" y=\"{3:.1f}\" text-anchor=\"middle\">{4}</text>\n",
        x(tick), top_, bottom_, bottom_ + 16.0, tick_text(tick, x_step));
  }
  const int wanted = std::clamp(static_cast<int>(plot_height() / 45.0), 3, kTicks);
  const double y_step = tick_step(y_axis_.low, y_axis_.high, wanted);
  for (const double tick : round_ticks(y_axis_.low, y_axis_.high, wanted)) {
    out += fmt::format(
        "<line class=\"grid\" x1=\"{0:.1f}\" y1=\"{2:.1f}\" x2=\"{1:.1f}\" y2=\"{2:.1f}\"/>\n"
        "<text x=\"{3:.1f}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
        left_, right_, y(tick), left_ - 7.0, y(tick) + 4.0, tick_text(tick, y_step));
  }
  const double middle = 0.5 * (top_ + bottom_);
  out += fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n"
      "<text x=\"14\" y=\"{:.1f}\" text-anchor=\"middle\" transform=\"rotate(-90 14 {:.1f})\">{}"
      "</text>\n",
      0.5 * (left_ + right_), bottom_ + 36.0, html_escaped(x_axis_.name), middle, middle,
      html_escaped(y_axis_.name));
}

std::string PlotFigure::svg(const std::string& description) const {
  // Clip paths have names that are the page's: the place of the plot is one that figures may share.
  const std::string clip = fmt::format("clip{:.0f}x{:.0f}", right_ - left_, bottom_ - top_);
  std::string out = fmt::format(
      "<svg viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" role=\"img\" "
      "aria-label=\"{2}\">\n<clipPath id=\"{3}\"><rect x=\"{4:.1f}\" y=\"{5:.1f}\" "
      "width=\"{6:.1f}\" "
      "height=\"{7:.1f}\"/></clipPath>\n",
      width_, bottom_ + kBottom, html_escaped(description), clip, left_, top_, right_ - left_,
      bottom_ - top_);
  draw_axes(out);
  out += fmt::format("<g clip-path=\"url(#{})\">\n{}</g>\n{}", clip, marks_, margin_);
  out += fmt::format(
      "<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
      "height=\"{:.1f}\"/>\n</svg>\n",
      left_, top_, right_ - left_, bottom_ - top_);
  return out;
}

}  // namespace nadir::calibration
