#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>
#include <vector>

#include "vision/marker_observation.h"

namespace nadir::calibration {

/// Variances by classes of pixel counts, as Goncalves, Lima and Costa publish them ("Real Time
/// Tracking of an Omnidirectional Robot", Tables 1 to 3; theory 4.2, 4.3). Classes are half open:
/// from_pixels of one class up to from_pixels of the next, the last without end; fewer pixels than
/// the first class are no measurement.
struct TableVariance {
  struct Class {
    double from_pixels = 0.0;
    double x_m2 = 0.0;
    double y_m2 = 0.0;
    /// Of the heading, with the centre disc in this class; one number for each class of the outer
    /// disc.
    std::vector<double> heading_rad2;
  };
  std::vector<Class> classes;  ///< at least one, by rising from_pixels
};

/// variance = pixel_variance / N + floor per axis (theory 4.3: 1.23e-4 m^2 fits Table 1, the
/// marker's size alone).
struct LawVariance {
  double pixel_variance_m2 = 1.23e-4;
  double floor_m2 = 1e-7;
  double minimum_pixels = 5.0;
};

/// Random drop-out of pixels (theory 4.1 c), per axis in the image, with r the disc's radius and N0
/// the count of a complete disc:
///
///     N0       = complete_share * expected pixels,   r^2 = N0 / pi
///     variance = r^2/4 (1/N - 1/N0) + the detector's own variance_px2 + floor_px^2
///
/// mapped to the plane by the Jacobian. No drop-out where N reaches N0: a soft count falls a few
/// percent short of the disc's area without any pixel lost, and the area is known no better.
struct DropOutVariance {
  double floor_px = 0.004;  ///< of what the detector does not see, per axis
  double minimum_pixels = 5.0;
  double complete_share = 0.85;  ///< above 0, at most 1
};

/// How well a disc seen with some number of pixels is placed: a value around one of the three laws.
/// A new law is one more alternative.
class PixelCountVariance {
 public:
  using Law = std::variant<DropOutVariance, LawVariance, TableVariance>;

  /// The drop-out law with its default constants.
  PixelCountVariance() = default;
  explicit PixelCountVariance(Law law) : law_(std::move(law)) {}

  /// Covariance of the disc's place on the plane, m^2, without the calibration's own part; nothing
  /// if the disc has too few pixels to be measured. `jacobian_m_per_px` is the plane map's at the
  /// disc's centre.
  std::optional<Eigen::Matrix2d> covariance_m2(const vision::DiscObservation& disc,
                                               const Eigen::Matrix2d& jacobian_m_per_px) const;

  /// Variance of the heading from a centre and one outer disc, rad^2, where the law is a table that
  /// states it itself; nothing for other laws or too few pixels. The table's own robot has its
  /// discs 40 mm apart.
  std::optional<double> heading_variance_rad2(double centre_pixels, double outer_pixels) const;

  const Law& law() const { return law_; }

 private:
  Law law_;
};

}  // namespace nadir::calibration
