#include "control_client/experiment/svg_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace nadir::control_client {
namespace {

std::string line(double x1, double y1, double x2, double y2, const char* look) {
  return fmt::format(
      "<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" class=\"{}\"/>\n", x1, y1, x2,
      y2, look);
}

std::string number(double value) {
  std::string text = fmt::format("{:g}", std::abs(value) < 1e-12 ? 0.0 : value);
  if (text.front() == '-') text.replace(0, 1, "\u2212");
  return text;
}

std::vector<double> decades(double from, double to) {
  std::vector<double> ticks;
  for (int e = static_cast<int>(std::ceil(std::log10(from) - 1e-9));
       e <= static_cast<int>(std::floor(std::log10(to) + 1e-9)); ++e) {
    ticks.push_back(std::pow(10.0, e));
  }
  return ticks;
}

}  // namespace

std::vector<double> round_ticks(double from, double to, int count) {
  const double raw = (to - from) / std::max(count, 1);
  const double decade = std::pow(10.0, std::floor(std::log10(raw)));
  const double share = raw / decade;
  const double step = decade * (share < 1.5 ? 1.0 : share < 3.5 ? 2.0 : share < 7.5 ? 5.0 : 10.0);
  std::vector<double> ticks;
  for (double tick = std::ceil(from / step - 1e-9) * step; tick <= to + 1e-9 * step; tick += step) {
    ticks.push_back(tick);
  }
  return ticks;
}

std::string svg_text(double x, double y, const std::string& text, const std::string& attributes) {
  std::string escaped;
  for (const char c : text) {
    escaped += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  }
  return fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" {}>{}</text>\n", x, y, attributes, escaped);
}

SvgAxes::SvgAxes(std::string id, const AxesBox& box, const AxesRange& range)
    : id_(std::move(id)), box_(box), range_(range) {}

double SvgAxes::x(double value) const {
  return box_.left + box_.width * (value - range_.x_from) / (range_.x_to - range_.x_from);
}

double SvgAxes::y(double value) const {
  const auto scale = [&](double v) { return range_.y_is_logarithmic ? std::log(v) : v; };
  const double share =
      (scale(range_.y_is_logarithmic ? std::max(value, 1e-12) : value) - scale(range_.y_from)) /
      (scale(range_.y_to) - scale(range_.y_from));
  return box_.top + box_.height * (1.0 - share);
}

std::string SvgAxes::frame(const std::string& title, const std::string& x_name,
                           const std::string& y_name) const {
  const double right = box_.left + box_.width;
  const double bottom = box_.top + box_.height;
  std::string out = fmt::format(
      "<clipPath id=\"{}\"><rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" "
      "height=\"{:.2f}\"/></clipPath>\n",
      id_, box_.left, box_.top, box_.width, box_.height);
  for (const double tick :
       round_ticks(range_.x_from, range_.x_to, static_cast<int>(box_.width / 70.0))) {
    out += line(x(tick), box_.top, x(tick), bottom, "grid");
    out += svg_text(x(tick), bottom + 16.0, number(tick), "text-anchor=\"middle\"");
  }
  const std::vector<double> y_ticks =
      range_.y_is_logarithmic
          ? decades(range_.y_from, range_.y_to)
          : round_ticks(range_.y_from, range_.y_to, static_cast<int>(box_.height / 55.0));
  for (const double tick : y_ticks) {
    out += line(box_.left, y(tick), right, y(tick), "grid");
    out += svg_text(box_.left - 6.0, y(tick) + 4.0, number(tick), "text-anchor=\"end\"");
  }
  out += fmt::format(
      "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" class=\"frame\"/>\n",
      box_.left, box_.top, box_.width, box_.height);
  out += svg_text(box_.left, box_.top - 9.0, title, "class=\"title\"");
  out += svg_text(box_.left + 0.5 * box_.width, bottom + 33.0, x_name, "text-anchor=\"middle\"");
  const double middle = box_.top + 0.5 * box_.height;
  out += svg_text(box_.left - 42.0, middle, y_name,
                  fmt::format("text-anchor=\"middle\" transform=\"rotate(-90 {:.2f} {:.2f})\"",
                              box_.left - 42.0, middle));
  return out;
}

std::string SvgAxes::curve(const std::vector<Eigen::Vector2d>& points,
                           const std::string& look) const {
  std::string path;
  for (const Eigen::Vector2d& point : points) {
    path += fmt::format("{}{:.2f} {:.2f}", path.empty() ? 'M' : 'L', x(point.x()), y(point.y()));
  }
  return fmt::format("<path d=\"{}\" class=\"{}\" clip-path=\"url(#{})\"/>\n", path, look, id_);
}

std::string SvgAxes::dot(const Eigen::Vector2d& point, double radius,
                         const std::string& look) const {
  return fmt::format(
      "<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{}\" class=\"{}\" clip-path=\"url(#{})\"/>\n",
      x(point.x()), y(point.y()), radius, look, id_);
}

std::string svg_page(double width, double height, const std::string& style,
                     const std::string& content) {
  constexpr const char* kStyle =
      R"(text { font-family: "DejaVu Sans", Verdana, Helvetica, Arial, sans-serif; font-size: 12px; fill: #222; }
.title { font-size: 13px; font-weight: bold; }
.note { font-size: 11px; fill: #555; }
.frame { fill: none; stroke: #444; }
.grid { stroke: #e6e6e6; }
path { fill: none; stroke-linejoin: round; stroke-linecap: round; stroke-width: 1.5; }
)";
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\">\n<style>\n{2}{3}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{4}</svg>\n",
      width, height, kStyle, style, content);
}

}  // namespace nadir::control_client
