#include "calibration/fit/map_fit.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace nadir::calibration {
namespace {

/// Smallest determinant of the Jacobian against its size: below, the image of a plane is a line.
constexpr double kFlattest = 1e-5;

vision::InputError error_at(const FieldPoints& points, int line, const std::string& cause,
                            const std::string& remedy) {
  return {{points.file, line, 0}, cause, remedy};
}

void check_numbers(ModelKind model, const FieldPoints& points) {
  if (points.points.size() < static_cast<std::size_t>(least_points(model))) {
    throw error_at(
        points, 0,
        fmt::format("holds {} points, too few for {}", points.points.size(), model_name(model)),
        fmt::format("give at least {}, better 20 or more, spread to the corners of the "
                    "field",
                    parameter_count(model)));
  }
  for (const FieldPoint& point : points.points) {
    if (point.pixel.allFinite() && point.position_m.allFinite()) continue;
    throw error_at(points, point.line, "a number is not finite", "correct or remove the point");
  }
}

void check_duplicates(const FieldPoints& points) {
  std::map<std::pair<double, double>, const FieldPoint*> seen;
  for (const FieldPoint& point : points.points) {
    const auto [entry, is_new] = seen.try_emplace({point.pixel.x(), point.pixel.y()}, &point);
    if (is_new || entry->second->position_m == point.position_m) continue;
    throw error_at(points, point.line,
                   fmt::format("the pixel of line {} stands here again with another place in "
                               "metres",
                               entry->second->line),
                   "remove the wrong one of the two");
  }
}

/// The image of a plane is neither a line nor folded: the Jacobian's determinant keeps its sign.
void check_orientation(const PlaneMap& map, const FieldPoints& points) {
  const double first = map.jacobian_m_per_px(points.points.front().pixel).determinant();
  for (const FieldPoint& point : points.points) {
    const Eigen::Matrix2d jacobian = map.jacobian_m_per_px(point.pixel);
    const double determinant = jacobian.determinant();
    if (std::abs(determinant) > kFlattest * jacobian.squaredNorm() && determinant * first > 0.0) {
      continue;
    }
    throw error_at(
        points, point.line,
        "the fitted map collapses or folds here: pixels and metres do not belong together",
        "check that x_m and y_m both vary, and that no rows are mixed up");
  }
}

PlaneMap solved(ModelKind model, const FieldPoints& points, const FitOptions& options) {
  const int order = polynomial_order(model);
  if (order > 0) return PlaneMap(fit_polynomial_map(order, points, options));
  return PlaneMap(fit_radial_map(model, points, options));
}

}  // namespace

vision::InputError undetermined_error(ModelKind model, const FieldPoints& points) {
  const int order = polynomial_order(model);
  const std::string curve = order == 0   ? "one line"
                            : order == 2 ? "one line or one curve of second order"
                                         : fmt::format("one curve of order {}", order);
  const std::string rows = order <= 2 ? "three rows and three columns"
                                      : fmt::format("{0} rows and {0} columns", order + 1);
  return error_at(
      points, 0,
      fmt::format("the points do not determine {}: they lie on {}", model_name(model), curve),
      fmt::format("spread them over the field in at least {}", rows));
}

PlaneMap fit_map(ModelKind model, const FieldPoints& points, const FitOptions& options) {
  check_numbers(model, points);
  check_duplicates(points);
  PlaneMap map = solved(model, points, options);
  check_orientation(map, points);
  return map;
}

}  // namespace nadir::calibration
