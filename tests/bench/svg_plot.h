#pragma once

#include <string>
#include <vector>

namespace nadir::bench {

// A small writer of figures: log-log panels side by side as one SVG that needs nothing else, on a
// light background, with the series' names beside the curves instead of a legend.

struct PlotPoint {
  double x = 0.0;  ///< above 0
  double y = 0.0;  ///< above 0
};

/// A series' name at a place in the panel, in its colour.
struct PlotLabel {
  std::string text;
  PlotPoint at;                  ///< start (or end) of the baseline
  std::string anchor = "start";  ///< of SVG: start, middle, end
};

struct PlotSeries {
  enum class Kind { kCurve, kDashes, kSteps, kRings, kDots };

  Kind kind = Kind::kCurve;  ///< kSteps: the points' pairs are the ends of level pieces
  std::string colour;        ///< of SVG
  std::vector<PlotPoint> points;
  std::vector<PlotLabel> labels;
};

struct PlotPanel {
  std::string title;
  std::string x_name;
  std::string y_name;
  double x_from = 1.0;
  double x_to = 10.0;
  double y_from = 1.0;
  double y_to = 10.0;
  std::vector<double> x_ticks;  ///< labelled with their numbers; y has one tick per decade
  std::vector<PlotSeries> series;
};

/// The figure's text. `caption`: lines under the panels.
std::string svg_figure(const std::vector<PlotPanel>& panels,
                       const std::vector<std::string>& caption);

}  // namespace nadir::bench
