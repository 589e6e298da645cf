#include "calibration/compare/compare_maps.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vision/input/input_error.h"

namespace nadir::calibration {
namespace {

using vision::InputError;

constexpr int kColumns = 24;
constexpr int kRows = 18;
/// Errors of a calibration are smooth, so that places are no independent witnesses: the whole is
/// taken for one, which exceeds three sigma by chance in about one pair of 100.
constexpr double kSignificantSigmas = 3.0;
constexpr double kNegligible_m = 1e-6;

PixelBox common_box(const Calibration& a, const Calibration& b, const std::string& first,
                    const std::string& second) {
  const bool sizes_known = a.image_width_px > 0 && b.image_width_px > 0;
  if (sizes_known &&
      (a.image_width_px != b.image_width_px || a.image_height_px != b.image_height_px)) {
    throw InputError({second},
                     fmt::format("is for images of {}x{}, but {} for {}x{}", b.image_width_px,
                                 b.image_height_px, first, a.image_width_px, a.image_height_px),
                     "compare calibrations of one camera");
  }
  PixelBox box{a.points_box.low_px.cwiseMax(b.points_box.low_px),
               a.points_box.high_px.cwiseMin(b.points_box.high_px)};
  if (!((box.high_px - box.low_px).minCoeff() > 0.0)) {
    throw InputError({second}, "has its points in another part of the image than " + first,
                     "compare calibrations whose points overlap");
  }
  return box;
}

PixelDifference difference_at(const PlaneMap& a, const PlaneMap& b,
                              const vision::PixelPoint& pixel) {
  PixelDifference result;
  result.pixel = pixel;
  result.place_m = a.plane_from_pixel(pixel);
  result.difference_m = b.plane_from_pixel(pixel) - result.place_m;
  result.difference_px = (a.jacobian_m_per_px(pixel).inverse() * result.difference_m).norm();
  result.expected_m =
      std::sqrt((a.calibration_covariance_m2(pixel) + b.calibration_covariance_m2(pixel)).trace());
  return result;
}

/// Least squares of a similarity without reflection (Umeyama, PAMI 1991), in closed form for the
/// plane.
PlaneMotion fit_motion(const std::vector<PixelDifference>& all) {
  PlaneMotion motion;
  const double count = static_cast<double>(all.size());
  for (const PixelDifference& each : all) {
    motion.centre_m += each.place_m / count;
    motion.shift_m += each.difference_m / count;
  }
  double squares = 0.0;
  double dot = 0.0;
  double cross = 0.0;
  for (const PixelDifference& each : all) {
    const Eigen::Vector2d from = each.place_m - motion.centre_m;
    const Eigen::Vector2d to = from + each.difference_m - motion.shift_m;
    squares += from.squaredNorm();
    dot += from.dot(to);
    cross += from.x() * to.y() - from.y() * to.x();
  }
  motion.turn_rad = std::atan2(cross, dot);
  motion.scale = std::hypot(cross, dot) / squares;
  Eigen::Matrix2d turn;
  turn << dot, -cross, cross, dot;
  turn /= squares;
  double rest = 0.0;
  for (const PixelDifference& each : all) {
    const Eigen::Vector2d from = each.place_m - motion.centre_m;
    rest += (from + each.difference_m - motion.shift_m - turn * from).squaredNorm() / count;
  }
  motion.rest_rms_m = std::sqrt(rest);
  return motion;
}

void set_statistics(MapComparison& comparison) {
  std::vector<double> lengths;
  double squares = 0.0;
  double squares_px = 0.0;
  double expected = 0.0;
  double ratio = 0.0;
  for (const PixelDifference& each : comparison.differences) {
    const double length = each.difference_m.norm();
    lengths.push_back(length);
    squares += length * length;
    squares_px += each.difference_px * each.difference_px;
    expected += each.expected_m * each.expected_m;
    const double floor = each.expected_m + kNegligible_m;
    ratio += length * length / (floor * floor);
    if (length > comparison.worst.difference_m.norm() || comparison.worst.expected_m == 0.0) {
      comparison.worst = each;
    }
  }
  const double count = static_cast<double>(lengths.size());
  std::sort(lengths.begin(), lengths.end());
  comparison.p95_m = lengths[static_cast<std::size_t>(std::ceil(0.95 * count)) - 1];
  comparison.rms_m = std::sqrt(squares / count);
  comparison.rms_px = std::sqrt(squares_px / count);
  comparison.expected_rms_m = std::sqrt(expected / count);
  comparison.is_significant = ratio / count > kSignificantSigmas * kSignificantSigmas;
}

}  // namespace

MapComparison compare_maps(const Calibration& a, const Calibration& b, const std::string& first,
                           const std::string& second) {
  const PixelBox box = common_box(a, b, first, second);
  MapComparison comparison;
  comparison.columns = kColumns;
  comparison.rows = kRows;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const Eigen::Vector2d share((column + 0.5) / kColumns, (row + 0.5) / kRows);
      comparison.differences.push_back(
          difference_at(a.map, b.map, box.low_px + share.cwiseProduct(box.high_px - box.low_px)));
    }
  }
  set_statistics(comparison);
  comparison.motion = fit_motion(comparison.differences);
  return comparison;
}

}  // namespace nadir::calibration
