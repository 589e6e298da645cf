#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <variant>

#include "calibration/convex_hull.h"
#include "calibration/diagnosis/lack_of_fit.h"
#include "calibration/model_kind.h"
#include "calibration/plane_shift.h"
#include "calibration/polynomial_map.h"
#include "calibration/radial_map.h"
#include "vision/pixel.h"

namespace nadir::calibration {

/// A place on the marker plane with what is known of its error.
struct PlanePoint {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();
};

/// Where points stood, and what they say of the model's own error.
struct MapSupport {
  LackOfFit lack_of_fit{};
  ConvexHull hull{};  ///< of the points' pixels; empty: unknown, nothing counts as outside
};

/// Pixels to metres on one plane, a value: cheap to copy, immutable. A new model is one more
/// alternative of the variant and one more file with plane_from_pixel, jacobian_m_per_px,
/// pixel_from_plane, unit_covariance, axis_basis and kind; nobody else changes.
class PlaneMap {
 public:
  using Model = std::variant<PolynomialMap, RadialMap>;

  explicit PlaneMap(Model model, MapSupport support = {})
      : model_(std::move(model)), support_(std::move(support)) {}

  /// Pixel to plane, metres.
  Eigen::Vector2d plane_from_pixel(const vision::PixelPoint& pixel) const;
  /// d(x_m, y_m)/d(u_px, v_px).
  Eigen::Matrix2d jacobian_m_per_px(const vision::PixelPoint& pixel) const;
  /// Plane to pixel, to 1e-9 m; nothing where no pixel shows the place, or only one beyond a fold
  /// of the map (where the image would be mirrored).
  std::optional<vision::PixelPoint> pixel_from_plane(const Eigen::Vector2d& plane_m) const;
  /// d(u_px, v_px)/d(x_m, y_m) at a place of the plane; nothing where pixel_from_plane has nothing.
  std::optional<Eigen::Matrix2d> jacobian_px_per_m(const Eigen::Vector2d& plane_m) const;

  /// The sampling error of the parameters, noise variance x D M^-1 D^T, m^2.
  Eigen::Matrix2d sampling_covariance_m2(const vision::PixelPoint& pixel) const;
  /// What the calibration itself adds to the error of a mapped point: the parameters' sampling
  /// error, the model's lack of fit there (theory 4.4), which grows with the leverage D M^-1 D^T
  /// where the points say nothing of it, and what is not known of the plane's height. Near points
  /// err alike.
  Eigen::Matrix2d calibration_covariance_m2(const vision::PixelPoint& pixel) const;
  /// Maps a pixel with its covariance: J C J^T + calibration_covariance_m2.
  PlanePoint map(const vision::PixelPoint& pixel, const Eigen::Matrix2d& covariance_px2) const;
  /// Outside of the hull of the points that were fitted.
  bool is_extrapolated(const vision::PixelPoint& pixel) const {
    return !support_.hull.holds(pixel);
  }

  /// The same map for another plane. Replaces an earlier shift.
  PlaneMap shifted(const PlaneShift& shift) const;

  ModelKind kind() const;
  const Model& model() const { return model_; }
  const MapSupport& support() const { return support_; }
  const std::optional<PlaneShift>& shift() const { return shift_; }

 private:
  /// On the calibrated plane.
  Eigen::Vector2d unshifted_place_m(const vision::PixelPoint& pixel) const;
  Eigen::Matrix2d unit_covariance(const vision::PixelPoint& pixel) const;
  double noise_variance_m2() const;
  Eigen::Vector2d lack_of_fit_m2(const vision::PixelPoint& pixel) const;

  Model model_;
  MapSupport support_;
  std::optional<PlaneShift> shift_;
};

}  // namespace nadir::calibration
