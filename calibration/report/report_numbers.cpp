#include "calibration/report/report_numbers.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calibration/fit/map_fit.h"
#include "vision/input/input_error.h"

namespace nadir::calibration {
namespace {

constexpr int kFieldCells = 48;   // along the longer side
constexpr double kMargin = 0.08;  // of the points' extent, on each side
constexpr int kCoverageColumns = 8;
constexpr int kCoverageRows = 6;

void lay_field(const FieldPoints& points, ReportNumbers& numbers) {
  numbers.low_m = points.points.front().position_m;
  numbers.high_m = numbers.low_m;
  for (const FieldPoint& point : points.points) {
    numbers.low_m = numbers.low_m.cwiseMin(point.position_m);
    numbers.high_m = numbers.high_m.cwiseMax(point.position_m);
  }
  const Eigen::Vector2d margin = kMargin * (numbers.high_m - numbers.low_m);
  numbers.low_m -= margin;
  numbers.high_m += margin;
  const Eigen::Vector2d extent = numbers.high_m - numbers.low_m;
  const double step = extent.maxCoeff() / kFieldCells;
  numbers.columns = std::max(4, static_cast<int>(std::lround(extent.x() / step)));
  numbers.rows = std::max(4, static_cast<int>(std::lround(extent.y() / step)));
}

FieldCell field_cell(const Calibration& calibration, const Eigen::Vector2d& place_m) {
  FieldCell cell;
  cell.place_m = place_m;
  const auto pixel = calibration.map.pixel_from_plane(place_m);
  if (!pixel) return cell;
  cell.pixel = *pixel;
  const bool size_known = calibration.image_width_px > 0;
  cell.is_seen = !size_known || (pixel->x() >= -0.5 && pixel->y() >= -0.5 &&
                                 pixel->x() < calibration.image_width_px - 0.5 &&
                                 pixel->y() < calibration.image_height_px - 0.5);
  cell.is_extrapolated = calibration.map.is_extrapolated(*pixel);
  cell.sigma_m = std::sqrt(calibration.map.calibration_covariance_m2(*pixel).trace() / 2.0);
  return cell;
}

void map_field(const Calibration& calibration, ReportNumbers& numbers) {
  double squares = 0.0;
  int inside = 0;
  for (int row = 0; row < numbers.rows; ++row) {
    for (int column = 0; column < numbers.columns; ++column) {
      const Eigen::Vector2d share((column + 0.5) / numbers.columns, (row + 0.5) / numbers.rows);
      const FieldCell cell = field_cell(
          calibration, numbers.low_m + share.cwiseProduct(numbers.high_m - numbers.low_m));
      numbers.field.push_back(cell);
      if (!cell.is_seen) continue;
      if (cell.is_extrapolated) {
        numbers.outside_max_m = std::max(numbers.outside_max_m, cell.sigma_m);
        continue;
      }
      squares += cell.sigma_m * cell.sigma_m;
      ++inside;
      numbers.inside_max_m = std::max(numbers.inside_max_m, cell.sigma_m);
    }
  }
  if (inside > 0) numbers.inside_rms_m = std::sqrt(squares / inside);
}

/// Every other point, in the order of rows of the field, so that both halves cover all of it.
std::pair<FieldPoints, FieldPoints> halves_of(const FieldPoints& points,
                                              const ReportNumbers& numbers) {
  std::vector<std::size_t> order(points.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const double bands = std::max(2.0, std::sqrt(static_cast<double>(order.size()) / 2.0));
  const double height_m = (numbers.high_m.y() - numbers.low_m.y()) / bands;
  const auto band = [&](std::size_t i) {
    return std::floor((points.points[i].position_m.y() - numbers.low_m.y()) / height_m);
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const double band_a = band(a);
    const double band_b = band(b);
    if (band_a != band_b) return band_a < band_b;
    return points.points[a].position_m.x() < points.points[b].position_m.x();
  });
  std::pair<FieldPoints, FieldPoints> halves{{points.file, {}}, {points.file, {}}};
  for (std::size_t i = 0; i < order.size(); ++i) {
    (i % 2 == 0 ? halves.first : halves.second).points.push_back(points.points[order[i]]);
  }
  return halves;
}

void solve_halves(const FieldPoints& points, const Calibration& calibration,
                  ReportNumbers& numbers) {
  const auto [first, second] = halves_of(points, numbers);
  FitOptions options;
  if (calibration.image_width_px > 0) {
    options.lens_centre_px = 0.5 * (numbers.image_low_px + numbers.image_high_px);
  }
  try {
    const PlaneMap a = fit_map(calibration.map.kind(), first, options);
    const PlaneMap b = fit_map(calibration.map.kind(), second, options);
    HalfDifference halves;
    double squares = 0.0;
    double expected = 0.0;
    int inside = 0;
    for (FieldCell& cell : numbers.field) {
      if (!cell.is_seen) continue;
      cell.half_difference_m = b.plane_from_pixel(cell.pixel) - a.plane_from_pixel(cell.pixel);
      if (cell.is_extrapolated) continue;
      const double length = cell.half_difference_m.norm();
      squares += length * length;
      // Half the points have twice the variance, and there are two halves.
      expected += 4.0 * calibration.map.sampling_covariance_m2(cell.pixel).trace();
      halves.max_m = std::max(halves.max_m, length);
      ++inside;
    }
    if (inside == 0) return;
    halves.rms_m = std::sqrt(squares / inside);
    halves.expected_rms_m = std::sqrt(expected / inside);
    numbers.halves = halves;
  } catch (const vision::InputError&) {
    // Half of the points do not determine the model: then there is no such test.
  }
}

void count_coverage(const FieldPoints& points, const Calibration& calibration,
                    ReportNumbers& numbers) {
  numbers.image_low_px = calibration.points_box.low_px;
  numbers.image_high_px = calibration.points_box.high_px;
  if (calibration.image_width_px > 0) {
    numbers.image_low_px = {-0.5, -0.5};
    numbers.image_high_px = {calibration.image_width_px - 0.5, calibration.image_height_px - 0.5};
  }
  const Eigen::Vector2d extent = numbers.image_high_px - numbers.image_low_px;
  const Eigen::Vector2d cell(extent.x() / kCoverageColumns, extent.y() / kCoverageRows);
  for (int row = 0; row < kCoverageRows; ++row) {
    for (int column = 0; column < kCoverageColumns; ++column) {
      const Eigen::Vector2d low =
          numbers.image_low_px + Eigen::Vector2d(column, row).cwiseProduct(cell);
      numbers.coverage.push_back({low, low + cell, 0});
    }
  }
  for (const FieldPoint& point : points.points) {
    const Eigen::Vector2d place = (point.pixel - numbers.image_low_px).cwiseQuotient(cell);
    const int column = std::clamp(static_cast<int>(place.x()), 0, kCoverageColumns - 1);
    const int row = std::clamp(static_cast<int>(place.y()), 0, kCoverageRows - 1);
    const std::size_t cell_index =
        static_cast<std::size_t>(row) * kCoverageColumns + static_cast<std::size_t>(column);
    ++numbers.coverage[cell_index].points;
  }
  for (const CoverageCell& each : numbers.coverage) numbers.empty_cells += each.points == 0 ? 1 : 0;
  numbers.hull_share = calibration.map.support().hull.area_px2() / (extent.x() * extent.y());
}

void normalise_residuals(const FieldPoints& points, const FieldResult& result,
                         ReportNumbers& numbers) {
  const StatedNoise& noise = result.calibration.noise;
  const double rms_axis_m = result.fit.residuals.rms_m / std::sqrt(2.0);
  int beyond = 0;
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const Eigen::Matrix2d jacobian =
        result.calibration.map.jacobian_m_per_px(points.points[i].pixel);
    Eigen::Vector2d sigma_m(rms_axis_m, rms_axis_m);
    if (noise.is_stated()) sigma_m = noise.variance_m2(jacobian).cwiseSqrt();
    for (int axis = 0; axis < 2; ++axis) {
      const double error_m = result.fit.point_residuals[i].error_m[axis];
      const double value = error_m / std::max(sigma_m[axis], 1e-12);
      numbers.normalised_residuals.push_back(value);
      beyond += std::abs(value) > 2.0 ? 1 : 0;
    }
  }
  numbers.beyond_two_sigma =
      static_cast<double>(beyond) / static_cast<double>(numbers.normalised_residuals.size());
}

}  // namespace

ReportNumbers report_numbers(const FieldPoints& points, const FieldResult& result) {
  ReportNumbers numbers;
  lay_field(points, numbers);
  map_field(result.calibration, numbers);
  count_coverage(points, result.calibration, numbers);
  solve_halves(points, result.calibration, numbers);
  normalise_residuals(points, result, numbers);
  return numbers;
}

}  // namespace nadir::calibration
