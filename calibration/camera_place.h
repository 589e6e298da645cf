#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calibration/field_points.h"
#include "calibration/fit/fit.h"

namespace nadir::calibration {

/// Where the camera's projection centre is, with its error: what brings a map to another height.
struct CameraPlace {
  /// How it is known.
  enum class Source {
    kGiven,      ///< measured by hand
    kFocal,      ///< a homography, taken apart with a given focal length
    kTwoHeights  ///< points at a second height
  };

  Eigen::Vector2d nadir_m = Eigen::Vector2d::Zero();  ///< the field's point below the camera
  double height_m = 0.0;                              ///< above the field, positive
  Eigen::Matrix2d nadir_covariance_m2 = Eigen::Matrix2d::Zero();
  double height_variance_m2 = 0.0;
  Source source = Source::kGiven;
};

/// A point that was surveyed at another height than the plane's.
struct PointAtHeight {
  FieldPoint point;
  double height_m = 0.0;  ///< above the field
};

/// What the user knows of the camera; at most one of the three is used, the first that is there.
struct CameraClues {
  std::optional<double> height_m{};  ///< with nadir_m: measured, to about kGivenCameraSigma_m
  std::optional<Eigen::Vector2d> nadir_m{};
  std::vector<PointAtHeight> other_heights{};
  std::optional<double> focal_px{};  ///< to about kFocalSigma of itself

  bool is_empty() const { return !height_m && !focal_px && other_heights.empty(); }
};

inline constexpr double kGivenCameraSigma_m = 0.02;
inline constexpr double kFocalSigma = 0.01;

/// The camera of a pinhole map (homography, radial, radial2) with this focal length: its homography
/// is K [r1 r2 t] (Zhang, A flexible new technique for camera calibration, 2000, section 3.1). The
/// lens centre of the map is the principal point. The covariance has the map's parameters, the
/// focal length's error and 1 % of it for the principal point. Throws std::invalid_argument for
/// another model.
CameraPlace camera_from_focal(const PlaneMap& map, double focal_px, double plane_height_m);

/// The camera from where points at other heights seem to stand on the map's plane: with
/// a = 1 / (H - h0), d = h - h0, p the mapped and x the surveyed place, x - p = d (a nadir - a p),
/// linear in a and a nadir. Throws InputError where they do not say where the camera is.
CameraPlace camera_from_heights(const PlaneMap& map, double plane_height_m,
                                const std::vector<PointAtHeight>& others, const StatedNoise& noise);

}  // namespace nadir::calibration
