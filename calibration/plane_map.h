#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <variant>

#include "calibration/polynomial_map.h"
#include "vision/pixel.h"

namespace nadir::calibration {

/// A place on the marker plane with what is known of its error.
struct PlanePoint {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();
};

/// Pixels to metres on one plane, a value: cheap to copy, immutable. A new model is one more
/// alternative of the variant and one more file with plane_from_pixel, jacobian_m_per_px,
/// calibration_covariance_m2 and centre_px; nobody else changes.
class PlaneMap {
 public:
  using Model = std::variant<PolynomialMap>;

  explicit PlaneMap(Model model) : model_(std::move(model)) {}

  /// Pixel to plane, metres.
  Eigen::Vector2d plane_from_pixel(const vision::PixelPoint& pixel) const;
  /// d(x_m, y_m)/d(u_px, v_px).
  Eigen::Matrix2d jacobian_m_per_px(const vision::PixelPoint& pixel) const;
  /// Plane to pixel by Newton's method from the linear guess, to 1e-9 m; nothing where it does not
  /// converge, or only beyond a fold of the map (where the image would be mirrored).
  std::optional<vision::PixelPoint> pixel_from_plane(const Eigen::Vector2d& plane_m) const;
  /// What the calibration itself adds to the error of a mapped point: the parameters' sampling
  /// error and the model's lack of fit there (theory 4.4). Near points err alike.
  Eigen::Matrix2d calibration_covariance_m2(const vision::PixelPoint& pixel) const;
  /// Maps a pixel with its covariance: J C J^T + calibration_covariance_m2.
  PlanePoint map(const vision::PixelPoint& pixel, const Eigen::Matrix2d& covariance_px2) const;

  const Model& model() const { return model_; }

 private:
  Model model_;
};

}  // namespace nadir::calibration
