#include "calibration/pixel_count_variance.h"

#include <algorithm>
#include <numbers>

namespace nadir::calibration {
namespace {

using vision::DiscObservation;
using OptionalCovariance = std::optional<Eigen::Matrix2d>;

/// Index of the class that holds a count.
std::optional<std::size_t> class_of(const TableVariance& table, double pixels) {
  const auto above = std::find_if(table.classes.begin(), table.classes.end(),
                                  [pixels](const auto& each) { return each.from_pixels > pixels; });
  if (above == table.classes.begin()) return std::nullopt;
  return static_cast<std::size_t>(above - table.classes.begin()) - 1;
}

OptionalCovariance covariance(const TableVariance& table, const DiscObservation& disc,
                              const Eigen::Matrix2d& /*jacobian_m_per_px*/) {
  const auto found = class_of(table, disc.pixels);
  if (!found) return std::nullopt;
  const TableVariance::Class& each = table.classes[*found];
  return Eigen::Vector2d(each.x_m2, each.y_m2).asDiagonal().toDenseMatrix();
}

OptionalCovariance covariance(const LawVariance& law, const DiscObservation& disc,
                              const Eigen::Matrix2d& /*jacobian_m_per_px*/) {
  if (!(disc.pixels >= law.minimum_pixels)) return std::nullopt;
  return (law.pixel_variance_m2 / disc.pixels + law.floor_m2) * Eigen::Matrix2d::Identity();
}

OptionalCovariance covariance(const DropOutVariance& law, const DiscObservation& disc,
                              const Eigen::Matrix2d& jacobian_m_per_px) {
  if (!(disc.pixels >= law.minimum_pixels)) return std::nullopt;
  // r^2/4 (1/N - 1/N0) with r^2 = N0/pi is (N0/N - 1) / (4 pi).
  const double complete_pixels = law.complete_share * disc.expected_pixels;
  const double drop_out_px2 =
      std::max(0.0, complete_pixels / disc.pixels - 1.0) / (4.0 * std::numbers::pi);
  const double variance_px2 = drop_out_px2 + disc.variance_px2 + law.floor_px * law.floor_px;
  return variance_px2 * jacobian_m_per_px * jacobian_m_per_px.transpose();
}

}  // namespace

OptionalCovariance PixelCountVariance::covariance_m2(
    const DiscObservation& disc, const Eigen::Matrix2d& jacobian_m_per_px) const {
  return std::visit([&](const auto& law) { return covariance(law, disc, jacobian_m_per_px); },
                    law_);
}

std::optional<double> PixelCountVariance::heading_variance_rad2(double centre_pixels,
                                                                double outer_pixels) const {
  const auto* table = std::get_if<TableVariance>(&law_);
  if (table == nullptr) return std::nullopt;
  const auto centre = class_of(*table, centre_pixels);
  const auto outer = class_of(*table, outer_pixels);
  if (!centre || !outer) return std::nullopt;
  return table->classes[*centre].heading_rad2.at(*outer);
}

}  // namespace nadir::calibration
