#include "calibration/fit/leave_one_out.h"

#include <Eigen/LU>
#include <cmath>

namespace nadir::calibration {
namespace {

/// (J J^T)^-1, the weight of a point whose distance counts in the image.
Eigen::Matrix2d image_weight(const RadialMap& map, const vision::PixelPoint& pixel) {
  const Eigen::Matrix2d jacobian = map.jacobian_m_per_px(pixel);
  return (jacobian * jacobian.transpose()).inverse();
}

/// D M^-1 D^T W of each point.
std::vector<Eigen::Matrix2d> hat_matrices(const PolynomialMap& map, const FieldPoints& points) {
  std::vector<Eigen::Matrix2d> hats;
  for (const FieldPoint& point : points.points) hats.push_back(map.unit_covariance(point.pixel));
  return hats;
}

std::vector<Eigen::Matrix2d> hat_matrices(const RadialMap& map, const FieldPoints& points) {
  double scale_m2 = 0.0;
  for (const FieldPoint& point : points.points) {
    scale_m2 += 0.5 * map.jacobian_m_per_px(point.pixel).squaredNorm() /
                static_cast<double>(points.points.size());
  }
  std::vector<Eigen::Matrix2d> hats;
  for (const FieldPoint& point : points.points) {
    hats.push_back(scale_m2 * map.unit_covariance(point.pixel) * image_weight(map, point.pixel));
  }
  return hats;
}

}  // namespace

std::vector<Eigen::Vector2d> leave_one_out_errors_m(const PlaneMap& bare_map,
                                                    const FieldPoints& points) {
  const std::vector<Eigen::Matrix2d> hats =
      std::visit([&](const auto& map) { return hat_matrices(map, points); }, bare_map.model());
  std::vector<Eigen::Vector2d> errors_m;
  errors_m.reserve(hats.size());
  for (std::size_t i = 0; i < hats.size(); ++i) {
    const FieldPoint& point = points.points[i];
    const Eigen::Vector2d error_m = point.position_m - bare_map.plane_from_pixel(point.pixel);
    errors_m.emplace_back((Eigen::Matrix2d::Identity() - hats[i]).inverse() * error_m);
  }
  return errors_m;
}

double chi_square_tail(double chi_square, double degrees_of_freedom) {
  const double spread = 2.0 / (9.0 * degrees_of_freedom);
  const double z =
      (std::cbrt(chi_square / degrees_of_freedom) - (1.0 - spread)) / std::sqrt(spread);
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

std::optional<ChiSquareTest> lack_of_fit_test(const PlaneMap& map, const FieldPoints& points,
                                              const StatedNoise& noise) {
  const int free = 2 * static_cast<int>(points.points.size()) - parameter_count(map.kind());
  if (!noise.is_stated() || free < 1) return std::nullopt;
  double sum = 0.0;
  for (const FieldPoint& point : points.points) {
    const Eigen::Matrix2d covariance_m2 = noise.covariance_m2(map.jacobian_m_per_px(point.pixel));
    const Eigen::Vector2d error_m = point.position_m - map.plane_from_pixel(point.pixel);
    if (!(covariance_m2.determinant() > 0.0)) return std::nullopt;  // a noise of zero
    sum += error_m.dot(covariance_m2.inverse() * error_m);
  }
  return ChiSquareTest{sum, free, chi_square_tail(sum, free)};
}

}  // namespace nadir::calibration
