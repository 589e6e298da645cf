#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calibration/field_calibration.h"
#include "calibration/field_points.h"

namespace nadir::calibration {

/// One place of the field as the calibration sees it.
struct FieldCell {
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
  vision::PixelPoint pixel = vision::PixelPoint::Zero();
  bool is_seen = false;  ///< the map shows it, inside the image where its size is known
  bool is_extrapolated = false;
  double sigma_m =
      0.0;  ///< own error of the calibration, one sigma: root of the mean variance per axis
  /// Second half's map minus first half's, metres.
  Eigen::Vector2d half_difference_m = Eigen::Vector2d::Zero();
};

/// A part of the image that holds points, or none.
struct CoverageCell {
  vision::PixelPoint low_px = vision::PixelPoint::Zero();
  vision::PixelPoint high_px = vision::PixelPoint::Zero();
  int points = 0;
};

/// Two maps from two halves of the points, every other point along the rows of the field (the
/// mrcal project's cross-validation difference): what they disagree by beyond their sampling error
/// is error that the covariance does not know of.
struct HalfDifference {
  double rms_m = 0.0;  ///< over the places inside the hull
  double max_m = 0.0;
  double expected_rms_m = 0.0;  ///< by the parameters' sampling error, four times its variance
};

/// What the pictures of a report show, and its JSON says.
struct ReportNumbers {
  // Cells of the field, row by row from its low corner.
  Eigen::Vector2d low_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d high_m = Eigen::Vector2d::Zero();
  int columns = 0;
  int rows = 0;
  std::vector<FieldCell> field;
  double inside_rms_m = 0.0;  ///< of sigma_m, inside the hull
  double inside_max_m = 0.0;
  double outside_max_m = 0.0;  ///< 0 where nothing is extrapolated

  std::optional<HalfDifference> halves;  ///< absent: too few points for two solves

  // Coverage.
  Eigen::Vector2d image_low_px = Eigen::Vector2d::Zero();  ///< of the image, or of the points' box
  Eigen::Vector2d image_high_px = Eigen::Vector2d::Zero();
  std::vector<CoverageCell> coverage;
  double hull_share = 0.0;  ///< of the image, or of the points' box
  int empty_cells = 0;

  /// Residuals per axis: x and y of every point, over the sigma that is stated for it, or, without
  /// a statement, over the RMS of all.
  std::vector<double> normalised_residuals;
  double beyond_two_sigma = 0.0;  ///< share; a normal distribution has 0.0455
};

ReportNumbers report_numbers(const FieldPoints& points, const FieldResult& result);

}  // namespace nadir::calibration
