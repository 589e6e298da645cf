#include "calibration/plane_map.h"

#include <Eigen/LU>

namespace nadir::calibration {
namespace {

constexpr double kInverseTolerance_m = 1e-9;
constexpr int kMaxNewtonSteps = 50;

}  // namespace

Eigen::Vector2d PlaneMap::plane_from_pixel(const vision::PixelPoint& pixel) const {
  return std::visit([&](const auto& model) { return model.plane_from_pixel(pixel); }, model_);
}

Eigen::Matrix2d PlaneMap::jacobian_m_per_px(const vision::PixelPoint& pixel) const {
  return std::visit([&](const auto& model) { return model.jacobian_m_per_px(pixel); }, model_);
}

std::optional<vision::PixelPoint> PlaneMap::pixel_from_plane(const Eigen::Vector2d& plane_m) const {
  // The first step from the centre is the linear guess: pixel += J^-1 (wanted - map(pixel)).
  vision::PixelPoint pixel =
      std::visit([](const auto& model) { return model.centre_px(); }, model_);
  const double orientation = jacobian_m_per_px(pixel).determinant();
  for (int step = 0; step < kMaxNewtonSteps; ++step) {
    const Eigen::Vector2d error_m = plane_m - plane_from_pixel(pixel);
    const Eigen::Matrix2d jacobian = jacobian_m_per_px(pixel);
    const double determinant = jacobian.determinant();
    if (determinant == 0.0 || !error_m.allFinite()) return std::nullopt;
    if (error_m.norm() <= kInverseTolerance_m) {
      if (determinant * orientation <= 0.0) return std::nullopt;
      return pixel;
    }
    pixel += jacobian.inverse() * error_m;
  }
  return std::nullopt;
}

Eigen::Matrix2d PlaneMap::calibration_covariance_m2(const vision::PixelPoint& pixel) const {
  return std::visit([&](const auto& model) { return model.calibration_covariance_m2(pixel); },
                    model_);
}

PlanePoint PlaneMap::map(const vision::PixelPoint& pixel,
                         const Eigen::Matrix2d& covariance_px2) const {
  const Eigen::Matrix2d jacobian = jacobian_m_per_px(pixel);
  return {plane_from_pixel(pixel),
          jacobian * covariance_px2 * jacobian.transpose() + calibration_covariance_m2(pixel)};
}

}  // namespace nadir::calibration
