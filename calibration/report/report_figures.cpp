#include "calibration/report/report_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "calibration/report/report_svg.h"

namespace nadir::calibration {
namespace {

using Corners = std::vector<std::pair<double, double>>;

constexpr double kWidth = 560.0;  // two beside each other at 1200 px
constexpr double kFlatHeight = 300.0;
constexpr std::size_t kWorst = 3;
/// The typical arrow is this share of the plot wide.
constexpr double kTypicalArrow = 0.035;
constexpr double kDot = 4.2;

PlotFigure field_figure(const ReportNumbers& numbers) {
  return {{"x on the field, m", numbers.low_m.x(), numbers.high_m.x()},
          {"y on the field, m", numbers.low_m.y(), numbers.high_m.y()},
          kWidth,
          0.0,
          true};
}

/// v points down, as in the image. With a rim, for points may lie on the border.
PlotFigure image_figure(const ReportNumbers& numbers) {
  constexpr double kRim = 0.02;
  const Eigen::Vector2d rim = kRim * (numbers.image_high_px - numbers.image_low_px);
  const Eigen::Vector2d low = numbers.image_low_px - rim;
  const Eigen::Vector2d high = numbers.image_high_px + rim;
  return {{"u in the image, px", low.x(), high.x()},
          {"v in the image, px", high.y(), low.y()},
          kWidth,
          0.0,
          true};
}

/// 1, 2 or 5 times a power of ten, not above `value`.
double round_below(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * decade <= value) return factor * decade;
  }
  return decade;
}

/// Hull of the points, on the field; its sides are curves there.
Corners hull_on_field(const Calibration& calibration) {
  constexpr int kSteps = 12;
  const auto& vertices = calibration.map.support().hull.vertices();
  Corners corners;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const vision::PixelPoint& from = vertices[i];
    const vision::PixelPoint& to = vertices[(i + 1) % vertices.size()];
    for (int step = 0; step < kSteps; ++step) {
      const Eigen::Vector2d place =
          calibration.map.plane_from_pixel(from + (to - from) * step / kSteps);
      corners.emplace_back(place.x(), place.y());
    }
  }
  return corners;
}

/// White dashes on a shadow: seen on every colour.
void draw_hull(PlotFigure& figure, const Calibration& calibration) {
  const Corners hull = hull_on_field(calibration);
  figure.polygon(hull, "hull shadow");
  figure.polygon(hull, "hull");
}

/// Cells of the field with a colour for each value, which has no colour where it is negative.
template <typename Value>
void draw_cells(PlotFigure& figure, const ReportNumbers& numbers, double highest, Value&& value) {
  const Eigen::Vector2d extent = numbers.high_m - numbers.low_m;
  const Eigen::Vector2d half(0.5 * extent.x() / numbers.columns, 0.5 * extent.y() / numbers.rows);
  for (const FieldCell& cell : numbers.field) {
    if (!cell.is_seen) continue;
    const Eigen::Vector2d low = cell.place_m - half;
    const Eigen::Vector2d high = cell.place_m + half;
    figure.cell(low.x(), low.y(), high.x(), high.y(), heat_colour(value(cell) / highest));
  }
}

std::vector<std::size_t> worst_of(const FieldResult& result) {
  std::vector<std::size_t> order(result.fit.point_residuals.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const std::size_t count = std::min(kWorst, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
                    [&](std::size_t a, std::size_t b) {
                      return result.fit.point_residuals[a].distance_m >
                             result.fit.point_residuals[b].distance_m;
                    });
  order.resize(count);
  return order;
}

std::string point_name(const FieldPoint& point, std::size_t index) {
  return point.line > 0 ? fmt::format("line {}", point.line) : fmt::format("point {}", index + 1);
}

/// Names beside points, towards the middle; none where one stands already.
void name_points(PlotFigure& figure, const FieldPoints& points,
                 const std::vector<std::size_t>& indices, double middle_x_m) {
  constexpr double kWidth_px = 60.0;
  constexpr double kHeight_px = 14.0;
  std::vector<Eigen::Vector2d> taken;
  for (const std::size_t i : indices) {
    const Eigen::Vector2d& place = points.points[i].position_m;
    const Eigen::Vector2d at(figure.x(place.x()), figure.y(place.y()));
    const bool is_free =
        std::none_of(taken.begin(), taken.end(), [&](const Eigen::Vector2d& other) {
          return std::abs(at.x() - other.x()) < kWidth_px &&
                 std::abs(at.y() - other.y()) < kHeight_px;
        });
    if (!is_free) continue;
    taken.push_back(at);
    const bool is_right = place.x() > middle_x_m;
    figure.label(place.x(), place.y(), is_right ? -6.0 : 6.0, 4.0, point_name(points.points[i], i),
                 is_right ? "end" : "start");
  }
}

}  // namespace

std::string residual_arrows(const FieldPoints& points, const FieldResult& result,
                            const ReportNumbers& numbers) {
  PlotFigure figure = field_figure(numbers);
  const auto& residuals = result.fit.point_residuals;
  const double rms_m = std::max(result.fit.residuals.rms_m, 1e-12);
  const double enlarged = kTypicalArrow * figure.plot_width() / figure.scale_x() / rms_m;
  const std::vector<std::size_t> worst = worst_of(result);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const Eigen::Vector2d& place = points.points[i].position_m;
    const Eigen::Vector2d arrow = enlarged * residuals[i].error_m;
    const bool is_worst = std::find(worst.begin(), worst.end(), i) != worst.end();
    figure.arrow(place.x(), place.y(), arrow.x(), arrow.y(), is_worst ? "arrow hot" : "arrow");
  }
  name_points(figure, points, worst, 0.5 * (numbers.low_m.x() + numbers.high_m.x()));
  const double key_m = round_below(1.6 * rms_m);
  figure.length_key(key_m * enlarged * figure.scale_x(),
                    fmt::format("{:g} mm of residual", 1e3 * key_m));
  return figure.svg("residual arrows over the field");
}

std::string residual_directions(const FieldPoints& points, const FieldResult& result,
                                const ReportNumbers& numbers) {
  PlotFigure figure = image_figure(numbers);
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const Eigen::Vector2d& error = result.fit.point_residuals[i].error_m;
    figure.dot(points.points[i].pixel.x(), points.points[i].pixel.y(), kDot,
               direction_colour(std::atan2(error.y(), error.x())));
  }
  figure.direction_key();
  return figure.svg("direction of the residuals over the image");
}

std::string residual_histogram(const FieldResult& result, const ReportNumbers& numbers) {
  constexpr int kBins = 32;
  constexpr double kReach = 4.0;
  std::vector<int> bins(kBins, 0);
  int outside = 0;
  for (const double value : numbers.normalised_residuals) {
    const double place = (value + kReach) / (2.0 * kReach) * kBins;
    if (place < 0.0 || place >= kBins) {
      ++outside;
    } else {
      ++bins[static_cast<std::size_t>(place)];
    }
  }
  const double count = static_cast<double>(numbers.normalised_residuals.size());
  const double width = 2.0 * kReach / kBins;
  const double at_zero = count * width / std::sqrt(2.0 * std::numbers::pi);
  const double highest =
      1.1 * std::max(at_zero, static_cast<double>(*std::max_element(bins.begin(), bins.end())));
  const bool stated = result.calibration.noise.is_stated();
  PlotFigure figure({stated ? "residual per axis / stated sigma" : "residual per axis / RMS of all",
                     -kReach, kReach},
                    {"residuals", 0.0, highest}, kWidth, kFlatHeight, false);
  for (int i = 0; i < kBins; ++i) {
    const double left = -kReach + i * width;
    figure.polygon({{left, 0.0},
                    {left, bins[static_cast<std::size_t>(i)]},
                    {left + width, bins[static_cast<std::size_t>(i)]},
                    {left + width, 0.0}},
                   "bar");
  }
  Corners normal;
  for (int i = 0; i <= 80; ++i) {
    const double value = -kReach + 2.0 * kReach * i / 80.0;
    normal.emplace_back(value, at_zero * std::exp(-0.5 * value * value));
  }
  figure.curve(normal, "curve");
  figure.note(outside > 0 ? fmt::format("{} beyond 4 sigma; line: normal distribution", outside)
                          : std::string("line: normal distribution"));
  return figure.svg("histogram of the residuals");
}

std::string error_map(const FieldPoints& points, const FieldResult& result,
                      const ReportNumbers& numbers) {
  PlotFigure figure = field_figure(numbers);
  // The scale is that of what counts: outside of the hull it may go off it.
  const double highest_mm = 1e3 * std::max(1.6 * numbers.inside_rms_m, 1.05 * numbers.inside_max_m);
  const double top_mm = std::max(highest_mm, 1e-6);
  draw_cells(figure, numbers, top_mm, [](const FieldCell& cell) { return 1e3 * cell.sigma_m; });
  draw_hull(figure, result.calibration);
  for (const FieldPoint& point : points.points) {
    figure.ring(point.position_m.x(), point.position_m.y(), 1.2, "speck");
  }
  figure.colour_key(0.0, top_mm, "mm");
  figure.note("dashed: hull of the points; outside it is extrapolated");
  return figure.svg("own error of the calibration over the field");
}

std::string half_difference_map(const FieldResult& result, const ReportNumbers& numbers) {
  PlotFigure figure = field_figure(numbers);
  const double inside_mm = 1e3 * numbers.halves.value_or(HalfDifference{}).max_m;
  const double top_mm = std::max(1.05 * inside_mm, 1e-6);
  draw_cells(figure, numbers, top_mm,
             [](const FieldCell& cell) { return 1e3 * cell.half_difference_m.norm(); });
  draw_hull(figure, result.calibration);
  figure.colour_key(0.0, top_mm, "mm");
  if (numbers.halves) {
    figure.note(fmt::format("RMS {:.3g} mm; noise alone: {:.3g} mm", 1e3 * numbers.halves->rms_m,
                            1e3 * numbers.halves->expected_rms_m));
  }
  return figure.svg("difference of two maps from two halves of the points");
}

std::string coverage_map(const FieldPoints& points, const FieldResult& result,
                         const ReportNumbers& numbers) {
  PlotFigure figure = image_figure(numbers);
  for (const CoverageCell& cell : numbers.coverage) {
    figure.polygon({{cell.low_px.x(), cell.low_px.y()},
                    {cell.high_px.x(), cell.low_px.y()},
                    {cell.high_px.x(), cell.high_px.y()},
                    {cell.low_px.x(), cell.high_px.y()}},
                   cell.points > 0 ? "covered" : "empty");
  }
  Corners hull;
  for (const vision::PixelPoint& vertex : result.calibration.map.support().hull.vertices()) {
    hull.emplace_back(vertex.x(), vertex.y());
  }
  figure.polygon(hull, "hull dark");
  for (const FieldPoint& point : points.points) {
    figure.ring(point.pixel.x(), point.pixel.y(), 1.6, "point");
  }
  figure.note(fmt::format("hull: {:.0f} % of the {}; hatched: no point", 100.0 * numbers.hull_share,
                          result.calibration.image_width_px > 0 ? "image" : "points' box"));
  return figure.svg("places of the points in the image");
}

}  // namespace nadir::calibration
