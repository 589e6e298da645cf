#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace nadir::calibration {

// A small writer of figures with linear axes, as pieces of SVG inside of a page. Colours of text,
// axes and paper are the page's (classes, not numbers), so that figures follow it in dark mode and
// in print.

/// One axis: "x, m" from `low` at its left (or lower) end to `high`; low may be the larger number.
struct PlotAxis {
  std::string name;  ///< with its unit
  double low = 0.0;
  double high = 1.0;
};

/// Round numbers in the range, about `wanted` of them.
std::vector<double> round_ticks(double low, double high, int wanted);
/// With as few digits as tell neighbours apart by `step`.
std::string tick_text(double value, double step);
/// With `&`, `<`, `>` and `"` spelled for HTML and SVG.
std::string html_escaped(std::string_view text);
/// From dark blue (0) over green to yellow (1): even in lightness, safe for the colour-blind.
std::string heat_colour(double share);
/// A hue for every direction; opposite directions have complementary colours.
std::string direction_colour(double angle_rad);

/// A figure with one pair of axes. Coordinates of the methods are those of the axes.
class PlotFigure {
 public:
  /// `width` of the whole figure in CSS pixels. With `equal_scale` the height follows from the
  /// ranges, so that a metre is as long in both axes; else it is `plot_height` and the margins.
  PlotFigure(PlotAxis x, PlotAxis y, double width, double plot_height, bool equal_scale);

  double x(double value) const;  ///< in the figure
  double y(double value) const;
  double scale_x() const;  ///< figure pixels per unit, not negative
  double plot_width() const { return right_ - left_; }
  double plot_height() const { return bottom_ - top_; }

  void cell(double x_low, double y_low, double x_high, double y_high, const std::string& fill);
  void dot(double at_x, double at_y, double radius, const std::string& fill);
  void ring(double at_x, double at_y, double radius, const char* css_class);
  /// `dx`, `dy` in units of the axes.
  void arrow(double at_x, double at_y, double dx, double dy, const char* css_class);
  void polygon(const std::vector<std::pair<double, double>>& corners, const char* css_class);
  void curve(const std::vector<std::pair<double, double>>& points, const char* css_class);
  /// Text beside a place, `offset` to the right in figure pixels.
  void label(double at_x, double at_y, double offset_x, double offset_y, const std::string& text,
             const char* anchor = "start");
  /// Text above the plot, at its right end.
  void note(const std::string& text);
  /// An arrow of a known length in figure pixels above the plot's left end: "5 mm".
  void length_key(double length, const std::string& text);
  /// A wheel of direction_colour right of the plot, with +x to the right and +y up.
  void direction_key();
  /// A strip of heat_colour right of the plot from `low` to `high`.
  void colour_key(double low, double high, const std::string& name);

  /// The finished <svg> element.
  std::string svg(const std::string& description) const;

 private:
  void draw_axes(std::string& out) const;

  PlotAxis x_axis_;
  PlotAxis y_axis_;
  double left_;
  double right_;
  double top_;
  double bottom_;
  double width_;
  std::string marks_;   ///< inside of the plot, clipped to it
  std::string margin_;  ///< around it
};

}  // namespace nadir::calibration
