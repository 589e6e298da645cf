#include "tests/bench/noise_figure.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "tests/bench/svg_plot.h"

namespace nadir::bench {
namespace {

using Kind = PlotSeries::Kind;

constexpr double kFewestPixels = 5.0;
constexpr double kMostPixels = 260.0;
constexpr const char* kPapersColour = "#777777";
constexpr const char* kLawColour = "#a06cb8";
constexpr std::array<const char*, 2> kStudyColours = {"#0b62a4", "#d1571b"};
constexpr std::array<const char*, 2> kDetectorColours = {"#7fb2d8", "#eba886"};

/// One number of a variance: the panel's.
using Part = double PoseVariance::*;

/// The papers' classes, level from one limit to the next.
PlotSeries papers_series(const calibration::TableVariance& papers, Part part) {
  PlotSeries series{Kind::kSteps, kPapersColour, {}, {}};
  const auto& classes = papers.classes;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const double y = part == &PoseVariance::place_m2 ? 0.5 * (classes[i].x_m2 + classes[i].y_m2)
                                                     : classes[i].heading_rad2[i];
    const double end = i + 1 < classes.size() ? classes[i + 1].from_pixels : kMostPixels;
    series.points.push_back({classes[i].from_pixels, y});
    series.points.push_back({end, y});
  }
  const PlotPoint& last = series.points.back();
  series.labels = {{part == &PoseVariance::place_m2 ? "papers, Table 1" : "papers, Tables 2 and 3",
                    {0.96 * last.x, 1.25 * last.y},
                    "end"}};
  return series;
}

PlotSeries law_series(const NoiseStudy& study, Part part) {
  PlotSeries series{Kind::kDashes, kLawColour, {}, {}};
  for (const CountNoise& count : study.counts) {
    series.points.push_back({count.pixels, count.published[1].*part});
  }
  const PlotPoint& last = series.points.back();
  series.labels = {{"1/N law", {0.96 * kMostPixels, 0.55 * last.y}, "end"}};
  return series;
}

/// Rings: measured. Solid: published by one of the laws.
void add_study(const NoiseStudy& study, Part part, std::size_t law, const char* colour,
               std::vector<PlotSeries>& all) {
  PlotSeries published{Kind::kCurve, colour, {}, {}};
  PlotSeries measured{Kind::kRings, colour, {}, {}};
  for (const CountNoise& count : study.counts) {
    const PoseVariance& errors = law == kDetectorLaw ? count.measured_detector : count.measured;
    published.points.push_back({count.pixels, count.published[law].*part});
    measured.points.push_back({count.pixels, errors.*part});
  }
  all.push_back(std::move(published));
  all.push_back(std::move(measured));
}

/// The studies' names in the lower left corner: few pixels place nothing that well, so it is free.
void name_studies(const std::vector<NoiseStudy>& studies, PlotPanel& panel) {
  const double line = std::pow(panel.y_to / panel.y_from, 0.055);
  double y = panel.y_from * std::pow(line, 0.6);
  const auto name = [&](const std::string& text, const char* colour) {
    const PlotPoint ring{1.14 * kFewestPixels, y * std::pow(line, 0.25)};
    panel.series.push_back({Kind::kRings, colour, {ring}, {{text, {1.08 * ring.x, y}, "start"}}});
    y *= line;
  };
  for (std::size_t i = 0; i < studies.size(); ++i) {
    name("aligned, " + studies[i].sensor, kStudyColours.at(i));
    name("detected, " + studies[i].sensor, kDetectorColours.at(i));
  }
}

PlotPanel panel(const std::vector<NoiseStudy>& studies, const calibration::TableVariance& papers,
                Part part) {
  const bool place = part == &PoseVariance::place_m2;
  PlotPanel made;
  made.title = place ? "Place, variance per axis" : "Heading, variance";
  made.x_name = "pixels that show a mark";
  made.y_name = place ? "m\u00b2" : "rad\u00b2";
  made.x_from = kFewestPixels;
  made.x_to = kMostPixels;
  made.x_ticks = {5, 10, 20, 30, 40, 100, 200};
  made.y_from = place ? 1e-13 : 1e-10;
  made.y_to = place ? 1e-4 : 1.0;
  made.series = {papers_series(papers, part), law_series(studies.front(), part)};
  for (std::size_t i = 0; i < studies.size(); ++i) {
    add_study(studies[i], part, kDetectorLaw, kDetectorColours.at(i), made.series);
    add_study(studies[i], part, 0, kStudyColours.at(i), made.series);
  }
  name_studies(studies, made);
  return made;
}

}  // namespace

std::string noise_figure(const std::vector<NoiseStudy>& studies,
                         const calibration::TableVariance& papers, double disc_distance_m) {
  int robots = 0;
  for (const NoiseStudy& study : studies) {
    for (const CountNoise& count : study.counts) robots += count.robots;
  }
  return svg_figure(
      {panel(studies, papers, &PoseVariance::place_m2),
       panel(studies, papers, &PoseVariance::heading_rad2)},
      {fmt::format(
           "Rings: mean squared error of {} two-marker robots (marks {:.0f} mm apart) under "
           "cameras near and far. Solid: the mean variance that nadir publishes.",
           robots, 1000.0 * disc_distance_m),
       "Grey: the tables of Goncalves, Lima and Costa (marks 40 mm apart; heading: both marks in "
       "the same class).",
       "Dashed: what nadir publishes with the 1/N law that fits their Table 1."});
}

}  // namespace nadir::bench
