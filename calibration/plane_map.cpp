#include "calibration/plane_map.h"

#include <Eigen/LU>
#include <algorithm>

namespace nadir::calibration {

Eigen::Vector2d PlaneMap::unshifted_place_m(const vision::PixelPoint& pixel) const {
  return std::visit([&](const auto& model) { return model.plane_from_pixel(pixel); }, model_);
}

Eigen::Vector2d PlaneMap::plane_from_pixel(const vision::PixelPoint& pixel) const {
  const Eigen::Vector2d place_m = unshifted_place_m(pixel);
  return shift_ ? shift_->shifted(place_m) : place_m;
}

Eigen::Matrix2d PlaneMap::jacobian_m_per_px(const vision::PixelPoint& pixel) const {
  const Eigen::Matrix2d jacobian =
      std::visit([&](const auto& model) { return model.jacobian_m_per_px(pixel); }, model_);
  return shift_ ? Eigen::Matrix2d(shift_->scale * jacobian) : jacobian;
}

std::optional<vision::PixelPoint> PlaneMap::pixel_from_plane(const Eigen::Vector2d& plane_m) const {
  const Eigen::Vector2d place_m = shift_ ? shift_->unshifted(plane_m) : plane_m;
  return std::visit([&](const auto& model) { return model.pixel_from_plane(place_m); }, model_);
}

std::optional<Eigen::Matrix2d> PlaneMap::jacobian_px_per_m(const Eigen::Vector2d& plane_m) const {
  const std::optional<vision::PixelPoint> pixel = pixel_from_plane(plane_m);
  if (!pixel) return std::nullopt;
  return jacobian_m_per_px(*pixel).inverse();
}

Eigen::Matrix2d PlaneMap::unit_covariance(const vision::PixelPoint& pixel) const {
  return std::visit([&](const auto& model) { return model.unit_covariance(pixel); }, model_);
}

double PlaneMap::noise_variance_m2() const {
  return std::visit([](const auto& model) { return model.parameters().noise_variance_m2; }, model_);
}

Eigen::Matrix2d PlaneMap::sampling_covariance_m2(const vision::PixelPoint& pixel) const {
  const double scale = shift_ ? shift_->scale : 1.0;
  return scale * scale * noise_variance_m2() * unit_covariance(pixel);
}

Eigen::Vector2d PlaneMap::lack_of_fit_m2(const vision::PixelPoint& pixel) const {
  const LackOfFit& lack = support_.lack_of_fit;
  Eigen::Vector2d variance_m2 = lack.mean_square_m2(pixel);
  if (lack.nodes().size() <= 1 || lack.box().holds(pixel)) return variance_m2;
  const double here = unit_covariance(pixel).trace();
  const double border = unit_covariance(lack.box().nearest(pixel)).trace();
  // A map without any covariance of its own has no leverage to compare.
  return border > 0.0 ? Eigen::Vector2d(variance_m2 * std::max(1.0, here / border)) : variance_m2;
}

Eigen::Matrix2d PlaneMap::calibration_covariance_m2(const vision::PixelPoint& pixel) const {
  Eigen::Matrix2d covariance_m2 = noise_variance_m2() * unit_covariance(pixel);
  covariance_m2.diagonal() += lack_of_fit_m2(pixel);
  if (!shift_) return covariance_m2;
  return shift_->scale * shift_->scale * covariance_m2 +
         shift_->covariance_m2(unshifted_place_m(pixel));
}

PlanePoint PlaneMap::map(const vision::PixelPoint& pixel,
                         const Eigen::Matrix2d& covariance_px2) const {
  const Eigen::Matrix2d jacobian = jacobian_m_per_px(pixel);
  return {plane_from_pixel(pixel),
          jacobian * covariance_px2 * jacobian.transpose() + calibration_covariance_m2(pixel)};
}

PlaneMap PlaneMap::shifted(const PlaneShift& shift) const {
  PlaneMap map = *this;
  map.shift_ = shift;
  return map;
}

ModelKind PlaneMap::kind() const {
  return std::visit([](const auto& model) { return model.kind(); }, model_);
}

}  // namespace nadir::calibration
