#include "calibration/fit/residuals.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace nadir::calibration {
namespace {

struct DistanceStatistics {
  double rms = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};

DistanceStatistics statistics(std::vector<double> distances) {
  std::sort(distances.begin(), distances.end());
  double sum = 0.0;
  for (const double distance : distances) sum += distance * distance;
  const auto count = static_cast<double>(distances.size());
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * count));
  return {std::sqrt(sum / count), distances.at(rank - 1), distances.back()};
}

}  // namespace

std::vector<PointResidual> residuals_of(const std::vector<Eigen::Vector2d>& errors_m,
                                        const PlaneMap& map, const FieldPoints& points) {
  std::vector<PointResidual> residuals;
  residuals.reserve(errors_m.size());
  for (std::size_t i = 0; i < errors_m.size(); ++i) {
    const Eigen::Matrix2d jacobian = map.jacobian_m_per_px(points.points[i].pixel);
    // On a fold of the map no pixel is near.
    const double distance_px = jacobian.determinant() == 0.0
                                   ? std::numeric_limits<double>::infinity()
                                   : (jacobian.inverse() * errors_m[i]).norm();
    residuals.push_back({errors_m[i], errors_m[i].norm(), distance_px});
  }
  return residuals;
}

std::vector<PointResidual> point_residuals(const PlaneMap& map, const FieldPoints& points) {
  std::vector<Eigen::Vector2d> errors_m;
  errors_m.reserve(points.points.size());
  for (const FieldPoint& point : points.points) {
    errors_m.emplace_back(point.position_m - map.plane_from_pixel(point.pixel));
  }
  return residuals_of(errors_m, map, points);
}

ResidualStatistics residual_statistics(const std::vector<PointResidual>& residuals) {
  std::vector<double> distances_m;
  std::vector<double> distances_px;
  for (const PointResidual& residual : residuals) {
    distances_m.push_back(residual.distance_m);
    distances_px.push_back(residual.distance_px);
  }
  const DistanceStatistics metres = statistics(std::move(distances_m));
  const DistanceStatistics pixels = statistics(std::move(distances_px));
  return {static_cast<int>(residuals.size()),
          metres.rms,
          metres.p95,
          metres.max,
          pixels.rms,
          pixels.p95,
          pixels.max};
}

}  // namespace nadir::calibration
