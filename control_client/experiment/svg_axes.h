#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace nadir::control_client {

/// A rectangle of a figure with linear or logarithmic axes, in the figure's own unit (px).
struct AxesBox {
  double left = 0.0;
  double top = 0.0;
  double width = 300.0;
  double height = 300.0;
};

/// Values at the ends of the axes.
struct AxesRange {
  double x_from = 0.0;
  double x_to = 1.0;
  double y_from = 0.0;
  double y_to = 1.0;  ///< at the top
  bool y_is_logarithmic = false;
};

/// Draws in SVG: frame, grid and ticks first, then curves, clipped to the box.
class SvgAxes {
 public:
  /// `id` is unique in the figure.
  SvgAxes(std::string id, const AxesBox& box, const AxesRange& range);

  double x(double value) const;
  double y(double value) const;

  /// Frame, grid lines at round numbers, their labels, names of the axes and a title.
  std::string frame(const std::string& title, const std::string& x_name,
                    const std::string& y_name) const;
  /// A curve through points, in the look of a class of the figure's style sheet.
  std::string curve(const std::vector<Eigen::Vector2d>& points, const std::string& look) const;
  std::string dot(const Eigen::Vector2d& point, double radius, const std::string& look) const;

 private:
  std::string id_;
  AxesBox box_;
  AxesRange range_;
};

/// Round numbers inside a range, about `count` of them: 1, 2 or 5 times a power of ten apart.
std::vector<double> round_ticks(double from, double to, int count);

std::string svg_text(double x, double y, const std::string& text, const std::string& attributes);

/// A whole figure with a white ground, in the look of all experiments. `style`: further lines of
/// its style sheet, each with its end.
std::string svg_page(double width, double height, const std::string& style,
                     const std::string& content);

}  // namespace nadir::control_client
